/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_REFERENCE_H
#define GM_TESTS_COMMON_REFERENCE_H

#include <stddef.h>

/* Values to compare with: arrays of numbers by name, from a file of tests/reference. In the file a line "NAME
   COUNT" begins an array, and COUNT numbers follow on as many lines as they like; a line "case WORD ..."
   begins a case, whose arrays follow; # begins a line of comment. GM_REFERENCE, that folder, comes from the
   build. What is not as it should be ends the program. */

/* Reads a file; one at a time is open. */
void reference_open(const char *file);
void reference_close(void);

/* The array of that name before all cases, which has so many numbers. */
const double *reference(const char *name, size_t count);

/* How many cases there are, and the words that name one, from 0. */
size_t reference_cases(void);
const char *reference_word(size_t index, size_t word);

/* An array of a case, and one of a single number. */
const double *reference_of(size_t index, const char *name, size_t count);
double reference_number(size_t index, const char *name);

#endif
