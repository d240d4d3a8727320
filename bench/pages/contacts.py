# SPDX-License-Identifier: BSD-3-Clause
"""contacts.md: first contacts of moving bodies, ours beside Bullet and FCL; every number from results.csv."""
import targets
from pages.figures import microseconds, picture, short, table

# What is said of a method below the table, where it was measured.
NOTES = {
    'Bullet continuous convex': '''`btContinuousConvexCollision`, which the sweep tests of `btCollisionWorld` take, in single precision as Debian
  builds it. It rounds the edges of a box by its margin of 4 cm: a corner that comes first is met late.''',
    'Bullet subsimplex cast': '`btSubsimplexConvexCast`. It does not turn bodies, and has no answer where they turn.',
    'FCL advancement': '''`continuousCollide` by conservative advancement to 1e-6, by libccd. It misses the contact of two boxes face to face.
  On the spline it steps over the contact: it takes the way that is left for the greatest speed ahead.''',
    'FCL advancement own GJK': 'the same by `GST_INDEP`: two boxes are met, the spline is not.',
    'FCL at 10 samples': 'the defaults of `continuousCollide`. A contact is found at the next sample.',
}


def cell(row):
    if row is None:
        return ''
    if int(row['failures']):
        return 'no answer'
    time, error = microseconds(float(row['median_us'])), float(row['error'])
    if targets.is_ours(row):
        return f"{time}, {'**wrong**' if int(row['unsound']) else short_power(error)}"
    if not int(row['unsound']):
        return f'{time}, {short_power(error)}'
    return f'{time}, **{"late by " + short_power(error) if error else "missed"}**'


def short_power(value):
    return f'{value:.0e}'.replace('e-0', 'e-') if 0 < value < 1e-3 else short(value)


def page(figures, out):
    rows = [row for row in figures.rows if (row['group'], row['workload']) == ('moving', 'contact')]
    methods = list(dict.fromkeys(row['method'] for row in rows))
    found = {(row['parameter'], row['method']): row for row in rows}
    lines = [[scene, *(cell(found.get((scene, method))) for method in methods)] for scene in dict.fromkeys(row['parameter'] for row in rows)]
    notes = '\n'.join(f'- {method}: {NOTES[method]}' for method in methods if method in NOTES)
    totals = [f"{method} {sum(int(found[scene[0], method]['unsound']) for scene in lines)}" for method in methods if method in NOTES]
    return f'''# First contacts of moving bodies

When does a body that moves first touch one that stands? The scenes are the nine of DART's comparative benchmark of
continuous collision. Their contacts are known in closed form (`test_continuous_collision`). Motions take 1 s.

Each cell has the time of an answer and how far the answer is from the truth [s]. **Late**: after the truth by more than
1e-6 s, **missed**: no contact was found. Ours is an interval: a contact that was found, and a time before which there is
none; it must contain the truth. All methods run in one process (`bench/moving.c`).

{table(['scene', *methods], lines)}

{notes}
{f"""
Late or missed in {len(lines)} scenes: {', '.join(totals)}, ours {sum(int(found[scene[0], targets.OURS]['unsound']) for scene in lines)}.
The casts of Bullet and FCL's advancement are faster: they work on one pair, and prove nothing about rounding. Ours makes the same query as for a
robot of many links in a scene.
""" if totals else ''}
Bullet takes two poses and moves at constant speed and rate of turning between them. This is exact for translations,
slerp, and the screw here, whose axis passes through the body's origin. The spline is 100 chords for Bullet. FCL takes
each motion by a class of its own: `TranslationMotion`, `InterpMotion`, `ScrewMotion`, and `SplineMotion` with the de Boor
points of the same curve. A hull of Bullet has no margin here; by default it is 4 cm larger than its points.

Points and balls along curves, beside Bullet on chords:

{picture(out, 'peers_time_of_contact', 'Time of contact along curves, beside Bullet')}
'''
