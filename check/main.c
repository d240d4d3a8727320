/* SPDX-License-Identifier: BSD-3-Clause */
/* cprox_check PROBLEM CERTIFICATES: says of each certificate what it proves, or why it does not.
 *
 * PROBLEM is the query as text ("-": standard input), CERTIFICATES a row of certificates, each behind its length (u32,
 * little endian), one a mover of the problem. doc/certificates.md has both formats. Exit: 0 all proven, 1 some not, 2
 * bad usage. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bytes.h"
#include "check.h"
#include "robot.h"

enum { EXIT_PROVEN = 0, EXIT_NOT_PROVEN = 1, EXIT_USAGE = 2 };

/* The whole file, or NULL. */
static unsigned char *read_all(const char *path, size_t *size) {
  FILE *in = fopen(path, "rb");
  if (!in) return NULL;
  unsigned char *bytes = NULL;
  size_t room = 0, got = 1;
  for (*size = 0; got > 0; *size += got) {
    if (*size + 65536 > room) {
      room = 2 * room + 65536;
      unsigned char *more = realloc(bytes, room);
      if (!more) {
        free(bytes);
        fclose(in);
        return NULL;
      }
      bytes = more;
    }
    got = fread(bytes + *size, 1, 65536, in);
  }
  fclose(in);
  return bytes;
}

/* Meshes are spoken of by their convex hulls: whose they are. Several parts in a row may have one name. */
static void report_hulls(const problem *p) {
  enum { MOST_NAMES = 4 };
  size_t named = 0, more = 0, parts = 0;
  const char *last = NULL, *before = "; meshes by their convex hulls: ";
  for (size_t i = 0; i < p->n_sets; i++) {
    const set *s = &p->sets[i];
    if (s->kind != HULL || (last && s->name[0] && strcmp(last, s->name) == 0)) continue;
    last = s->name;
    if (named == MOST_NAMES) {
      more++;
      continue;
    }
    printf("%s", before);
    if (s->name[0])
      printf("'%s'", s->name);
    else
      printf("target %zu", i);
    before = ", ";
    named++;
  }
  const robot *r = p->mover.robot;
  for (size_t i = 0; r && i < r->n_parts; i++) parts += r->parts[i].kind == HULL;
  if (more > 0) printf(" and %zu more", more);
  if (parts > 0) printf("%s%zu of the robot's %zu bodies", before, parts, r->n_parts);
}

/* What is proven, to be followed by "(". */
static void say(const finding *f) {
  if (f->claim == CLAIM_NEAR) printf("not farther than %.17g m", f->delta);
  if (f->claim == CLAIM_APART) printf("farther than %.17g m everywhere", f->delta);
  if (f->claim == CLAIM_BEFORE) printf("farther than %.17g m before %.17g", f->delta, f->until);
  if (f->claim == CLAIM_DURING) printf("farther than %.17g m from %.17g to %.17g", f->delta, f->from, f->until);
  if (f->meets) printf(", and by %.17g not farther than %.17g m", f->meets_by, f->meets_delta);
}

static void refuse(const finding *f) {
  fputs(f->fault, stdout);
  if (f->leaves > 0) printf(", at direction %zu", f->leaves);
  puts("");
}

/* Several certificates of one mover: "CPCP", u32 n, n × {u32 length, certificate}. All must hold. */
static bool report_parts(const problem *p, const unsigned char *bytes, size_t size) {
  reader in = {.at = bytes + 4, .end = bytes + size};
  const uint32_t n = reader_count(&in);
  size_t leaves = 0;
  for (int pass = 0; pass < 2; pass++) { /* the first one finds out whether all hold */
    reader part = in;
    if (pass == 1) printf("%s: proven: ", p->mover.id);
    for (uint32_t i = 0; i < n; i++) {
      const uint32_t length = reader_count(&part);
      const bool cut_off = part.bad || length > reader_left(&part);
      const finding found = cut_off ? (finding){.fault = "it is cut off"} : check(p, part.at, length);
      if (found.fault) {
        printf("%s: refused: part %u of %u: ", p->mover.id, (unsigned)i + 1, (unsigned)n);
        refuse(&found);
        return false;
      }
      part.at += length;
      leaves += found.leaves;
      if (pass == 0) continue;
      if (i > 0) printf("; ");
      say(&found);
    }
    if (pass == 0 && (n == 0 || part.bad || part.at != part.end)) {
      printf("%s: refused: %s\n", p->mover.id, n == 0 ? "it has no parts" : "bytes follow its end");
      return false;
    }
  }
  printf(" (%u bytes, %u parts, %zu directions", (unsigned)size, (unsigned)n, leaves / 2);
  report_hulls(p);
  puts(")");
  return true;
}

/* One certificate and its line of the report; whether it proves anything. */
static bool report(const problem *p, reader *file) {
  const uint32_t size = reader_count(file);
  if (file->bad || size > reader_left(file)) {
    printf("%s: refused: the file of certificates ends early\n", p->mover.id);
    file->bad = true;
    return false;
  }
  const unsigned char *bytes = file->at;
  file->at += size;
  if (size == 0 || p->mover.none) {
    printf("%s: nothing is claimed\n", p->mover.id);
    return false;
  }
  if (size >= 4 && memcmp(bytes, "CPCP", 4) == 0) return report_parts(p, bytes, size);
  const finding found = check(p, bytes, size);
  if (found.claim == CLAIM_NONE) {
    printf("%s: refused: ", p->mover.id);
    refuse(&found);
    return false;
  }
  printf("%s: proven: ", p->mover.id);
  say(&found);
  printf(" (%u bytes", (unsigned)size);
  if (found.claim != CLAIM_NEAR) {
    printf(", %zu directions", found.leaves);
    report_hulls(p);
  }
  puts(")");
  return true;
}

int main(int argc, char **argv) {
  if (argc != 3) {
    fputs("usage: cprox_check PROBLEM CERTIFICATES (doc/certificates.md); PROBLEM may be - for standard input\n",
          stderr);
    return EXIT_USAGE;
  }
  FILE *in = strcmp(argv[1], "-") == 0 ? stdin : fopen(argv[1], "r");
  size_t size = 0;
  unsigned char *bytes = read_all(argv[2], &size);
  if (!in || !bytes) {
    fprintf(stderr, "cprox_check: %s cannot be read\n", in ? argv[2] : argv[1]);
    free(bytes);
    if (in && in != stdin) fclose(in);
    return EXIT_USAGE;
  }

  problem p;
  reader file = {.at = bytes, .end = bytes + size};
  bool all = problem_open(&p, in);
  while (all || !p.fault[0]) {
    if (!problem_next(&p)) break;
    if (!report(&p, &file)) all = false;
  }
  int code = all ? EXIT_PROVEN : EXIT_NOT_PROVEN;
  if (p.fault[0]) {
    fprintf(stderr, "cprox_check: %s\n", p.fault);
    code = EXIT_USAGE;
  } else if (!file.bad && reader_left(&file) > 0) {
    puts("refused: there are more certificates than movers");
    code = EXIT_NOT_PROVEN;
  }
  problem_close(&p);
  free(bytes);
  if (in != stdin) fclose(in);
  return code;
}
