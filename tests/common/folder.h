/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_FOLDER_H
#define GM_TESTS_COMMON_FOLDER_H

#include <stddef.h>

/* A folder of a test's own, below the one for temporary files. */

/* Makes it and names it; ends the program if it cannot. */
void folder_make(char *path, size_t size);
/* Removes it with all that it holds. */
void folder_remove(const char *path);
/* How many names it holds, hidden ones included. */
int folder_count(const char *path);

/* Writes text to a file that anybody may execute. */
void folder_script(const char *path, const char *text);

#endif
