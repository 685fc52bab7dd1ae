/* SPDX-License-Identifier: GPL-3.0-or-later */
/* One line of a file, without reading what else the file says. */
#include <stdlib.h>
#include <string.h>

#include "core/expression/lines.h"
#include "core/files/files.h"

const char *const gm_file_endings[GM_FILE_KINDS] = {".system", ".room",    ".scheme",  ".tour",
                                                    ".msh",    ".subject", ".figures", ".page"};

char *gm_file_line(const char *text, size_t length, const char *word)
{
    struct gm_text_line line;
    struct gm_fault fault;
    size_t at = 0;
    while (gm_lines_next(text, length, &at, &line, &fault)) {
        if (gm_span_is(text, line.word, word)) {
            return gm_span_words(text, line.value);
        }
    }
    return strdup("");
}

char *gm_file_title(const char *text, size_t length)
{
    char *name = gm_file_line(text, length, "name");
    if (!name || name[0]) {
        return name;
    }
    free(name);
    return gm_file_line(text, length, "title");
}
