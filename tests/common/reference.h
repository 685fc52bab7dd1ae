/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_REFERENCE_H
#define GM_TESTS_COMMON_REFERENCE_H

#include <stddef.h>
#include <stdio.h>

/* Values to compare with: arrays of numbers by name, from a file of tests/reference. In the file a line "NAME
   COUNT" begins an array, and COUNT numbers follow on as many lines as they like; # begins a line of comment.
   GM_REFERENCE, that folder, comes from the build. What is not as it should be ends the program. */

/* A file of that folder, or relative to it, to be read in another way. */
FILE *reference_file(const char *file);

/* Reads a file; one at a time is open. */
void reference_open(const char *file);
void reference_close(void);

/* The array of that name, which has so many numbers. */
const double *reference(const char *name, size_t count);

#endif
