/* SPDX-License-Identifier: BSD-3-Clause */
/* reading INPUTS SEED NAME…: of each pair of files NAME.problem and NAME.certificates the text, or the first certificate,
 * or both are changed at random (bytes, words that go or become other ones, cuts), INPUTS times in all, and handed to
 * the checker. For sanitizers; the programs that end in _mutants judge whether what is accepted is true. Prints the most
 * processor time that a megabyte took, a text below a tenth of one being taken for a tenth. */
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "prove.h"
#include "support/random.h"

enum { MOST = 1 << 20, LEAST = 100000 };

typedef struct buffer {
  size_t n;
  unsigned char at[MOST];
} buffer;

static bool load(const char *name, const char *kind, buffer *out) {
  char path[512];
  snprintf(path, sizeof path, "%s.%s", name, kind);
  FILE *in = fopen(path, "rb");
  if (!in) return false;
  out->n = fread(out->at, 1, MOST, in);
  fclose(in);
  return out->n > 0 && out->n < MOST;
}

/* n bytes at `from` become those of the word. */
static void replace(buffer *b, size_t from, size_t n, const char *word, size_t length) {
  if (b->n - n + length >= MOST) return;
  memmove(b->at + from + length, b->at + from + n, b->n - from - n);
  memcpy(b->at + from, word, length);
  b->n += length - n;
}

static void change_bytes(buffer *b, rng *r) {
  if (b->n == 0) return;
  const size_t at = rng_index(r, b->n), rest = b->n - at, n = 1 + rng_index(r, rest < 16 ? rest : 16);
  static const unsigned char large[8] = {0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xef, 0x7f};
  switch (rng_index(r, 5)) {
    case 0: b->at[at] ^= (unsigned char)(1u << rng_index(r, 8)); break;
    case 1: b->at[at] = (unsigned char)rng_index(r, 256); break;
    case 2: b->n = at; break;
    case 3: replace(b, at, n, "", 0); break;
    default: memcpy(b->at + at, large, rest < sizeof large ? rest : sizeof large); break;
  }
}

static void change_word(buffer *b, rng *r) {
  static const char *const words[] = {"0",   "-1",    "4294967295", "10000000", "nan",
                                      "inf", "1e308", "solid",      "\n",       "curve"};
  if (b->n == 0) return;
  size_t from = rng_index(r, b->n), to;
  while (from > 0 && b->at[from - 1] > ' ') from--;
  for (to = from; to < b->n && b->at[to] > ' ';) to++;
  const char *word = words[rng_index(r, sizeof words / sizeof *words)];
  if (rng_index(r, 4) == 0)
    replace(b, from, to - from, "", 0);
  else
    replace(b, from, to - from, word, strlen(word));
}

int main(int argc, char **argv) {
  static buffer text, file, made, certificate;
  if (argc < 4) {
    fputs("usage: reading INPUTS SEED NAME ...\n", stderr);
    return 2;
  }
  const size_t inputs = strtoul(argv[1], NULL, 10), pairs = (size_t)(argc - 3);
  rng r = rng_seed(strtoumax(argv[2], NULL, 10));
  size_t proven = 0, tried = 0;
  double slowest = 0.0;
  for (size_t k = 0; k < pairs; k++) {
    if (!load(argv[3 + k], "problem", &text) || !load(argv[3 + k], "certificates", &file)) continue;
    uint32_t size = 0;
    for (int i = 3; i >= 0; i--) size = size << 8 | file.at[i];
    if (size == 0 || size > file.n - 4) continue;
    for (size_t i = 0; i < inputs / pairs; i++) {
      made.n = text.n, certificate.n = size;
      memcpy(made.at, text.at, text.n);
      memcpy(certificate.at, file.at + 4, size);
      const size_t what = rng_index(&r, 3);
      for (size_t times = 1 + rng_index(&r, 3); times > 0; times--) {
        if (what != 1 && rng_index(&r, 3) > 0) change_word(&made, &r);
        if (what != 1 && rng_index(&r, 3) == 0) change_bytes(&made, &r);
        if (what != 0) change_bytes(&certificate, &r);
      }
      const clock_t start = clock();
      const proof found = prove((const char *)made.at, made.n, certificate.at, certificate.n);
      const double took = (double)(clock() - start) / CLOCKS_PER_SEC;
      const size_t given = made.n + certificate.n;
      const double share = took / ((double)(given > LEAST ? given : LEAST) / 1e6);
      if (share > slowest) slowest = share;
      proven += found.fault[0] == 0;
      tried++;
    }
  }
  printf("%zu inputs, of which %zu prove something; at most %.2g s a megabyte\n", tried, proven, slowest);
  printf("%zu passed, %d failed\n", tried, tried == 0);
  return tried == 0;
}
