# SPDX-License-Identifier: BSD-3-Clause
"""foreign_messages.py DEFINITIONS OUT TEMPLATES -IPACKAGE:FOLDER...

C++ classes of the messages in DEFINITIONS/PACKAGE/{msg,srv}, by gencpp, as OUT/foreign/PACKAGE/MESSAGE.h. Their namespaces
are within curve_proximity: a process may hold the classes of the packages themselves, too."""
import os
import re
import sys

import genmsg.template_tools

definitions, out, templates, *include = sys.argv[1:]
packages = sorted(os.listdir(definitions))
include = [path[2:] for path in include] + ['%s:%s/%s/msg' % (package, definitions, package) for package in packages]
any_of = '(%s)' % '|'.join(packages)
for package in packages:
    folder = os.path.join(out, 'foreign', package)
    for kind in os.listdir(os.path.join(definitions, package)):
        for name in os.listdir(os.path.join(definitions, package, kind)):
            genmsg.template_tools.generate_from_file(os.path.join(definitions, package, kind, name), package, folder, templates, include,
                                                     {'msg.h.template': '@NAME@.h'}, {'srv.h.template': '@NAME@.h'})
    for name in os.listdir(folder):
        with open(os.path.join(folder, name)) as header:
            text = header.read()
        text = re.sub('(?<=#include <)%s(?=/)' % any_of, r'foreign/\1', text)
        text = re.sub('(?<=namespace )%s$' % any_of, r'curve_proximity::\1', text, flags=re.M)
        text = re.sub('(?<= ::)%s(?=::)' % any_of, r'curve_proximity::\1', text)
        text = re.sub('%s_MESSAGE_' % any_of.upper(), r'FOREIGN_\1_MESSAGE_', text)
        with open(os.path.join(folder, name), 'w') as header:
            header.write(text)
