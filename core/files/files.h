/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files of share/ that are part of the program: systems, rooms, the meshes of rooms, schemes, tours, the
   systems that schemes alone are certified on, statements on published figures, and pages that the program
   completes. The build writes them into an array (core/files/main.c), and nothing opens them at run time. */
#ifndef GM_CORE_FILES_FILES_H
#define GM_CORE_FILES_FILES_H

#include <stddef.h>

enum gm_file_kind {
    GM_FILE_SYSTEM,
    GM_FILE_ROOM,
    GM_FILE_SCHEME,
    GM_FILE_TOUR,
    GM_FILE_MESH,
    GM_FILE_SUBJECT,
    GM_FILE_FIGURES,
    GM_FILE_PAGE,
    GM_FILE_KINDS
};

/* The endings of their file names, ".system". */
extern const char *const gm_file_endings[GM_FILE_KINDS];

struct gm_built_in {
    enum gm_file_kind kind;
    const char *path;          /* below share/, "systems/toda.system" */
    const char *name;          /* "toda"; of a mesh with its ending */
    const char *title, *about; /* gm_file_title, and the line of that word; "" */
    const char *text;          /* closed by a zero */
    size_t length;             /* of the text */
};
extern const struct gm_built_in gm_built_in_files[];
extern const size_t gm_built_in_count;

/* The built-in file of that kind and name, or NULL. */
const struct gm_built_in *gm_built_in_find(enum gm_file_kind kind, const char *name);

/* Returns the value of the text's first line `word:`, with one blank between its words, or "" without such a line.
   NULL: out of memory; the caller frees. */
char *gm_file_line(const char *text, size_t length, const char *word);
/* Returns the name of the file in lists, from its line `name:`, or else `title:`; like gm_file_line. */
char *gm_file_title(const char *text, size_t length);

#endif
