/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_BASE_FILES_H
#define GM_APP_BASE_FILES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "core/files/files.h"

/* Files of systems, rooms, schemes and tours by name. A word with the ending of such a file is a path. Any
   other word is the name of a file in the program, in the folder of GEOMINT_SYSTEMS (GEOMINT_ROOMS,
   GEOMINT_SCHEMES, GEOMINT_TOURS), or in $XDG_CONFIG_HOME/geomint, or ~/.config/geomint; the first of
   these counts. */

struct gm_file {
    const struct gm_built_in *built_in; /* NULL: it is at the path */
    char path[4096];                    /* the path of the file; a built-in one is below share/ */
};

/* The file that a word means; false: no name of this kind is that word. */
bool gm_file_find(enum gm_file_kind kind, const char *word, struct gm_file *file);
/* Returns true if the word means a file. */
bool gm_file_is(enum gm_file_kind kind, const char *word);

/* The file's text, ended by a zero byte; malloc'ed. Returns NULL with a sentence (GM_MESSAGE bytes) if it
   cannot be read, or has more than `most` bytes. */
char *gm_file_read(const struct gm_file *file, size_t most, size_t *length, char *message);

/* A name, the title in lists (gm_file_title), and the line `about:`; "" if it cannot be read. */
struct gm_listed {
    const char *name, *title, *about;
    const struct gm_file *file;
};
/* Calls `each` for every file that has a name of this kind, except files for which memory is short.
   Returns false with a sentence if the environment names a folder that cannot be opened. */
bool gm_files_each(enum gm_file_kind kind, void (*each)(const struct gm_listed *listed, const void *data),
                   const void *data, char *message);
/* Returns true if the environment names no folder or one that can be opened; else false with the sentence. */
bool gm_files_folder_opens(enum gm_file_kind kind, char *message);

enum { GM_PAGE_SLOT = 16 };
/* A page of the program, in which {{SLOT}} stands for what is written there: it stands alone in its line, which it
   replaces, or among words. Its text; and this writes the text up to the next slot and sets the slot's name
   and the text after it, or returns false after the last one. */
const char *gm_page_text(const char *name);
bool gm_page_next(FILE *page, const char **text, char slot[GM_PAGE_SLOT]);

/* The place of a fault in some words. */
struct gm_word_place {
    int word;      /* index of the word; negative: no word has it */
    size_t offset; /* bytes from the start of the word */
};

struct gm_fault;

/* Reports a fault of a file's text, with its line and column (GM_MESSAGE bytes). */
void gm_place_report(const char *path, const char *text, const struct gm_fault *fault, char *message);

/* Appends to a message (GM_MESSAGE bytes) the faulty line of a text, and below it a line with a caret at
   the place. Only ASCII is shown unchanged. */
void gm_place_show(const char *text, size_t length, size_t offset, char *message);

#endif
