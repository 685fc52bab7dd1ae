/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Sentences on standard error, lines on standard output, wrapped to its width, and whether they arrived. */
#include "app/output/say.h"

#include <errno.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "render/cells/text.h"

static atomic_bool complained_of_memory;

__attribute__((format(printf, 3, 0))) static void put_line(FILE *stream, const char *front,
                                                           const char *format, va_list arguments)
{
    char text[8192]; /* a path may have 4096 bytes */
    vsnprintf(text, sizeof text, format, arguments);
    if (stream == stderr && strstr(text, "not enough memory")) {
        atomic_store(&complained_of_memory, true);
    }
    char *rest = text; /* the place in a text is shown on separate lines */
    for (char *line; (line = strsep(&rest, "\n")); front = "") {
        fprintf(stream, "%s%s\n", front, gm_text_tame(line));
    }
}

void gm_complain(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    put_line(stderr, "geomint: ", format, arguments);
    va_end(arguments);
}

int gm_give_up(int status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    put_line(stderr, "geomint: ", format, arguments);
    va_end(arguments);
    return status;
}

bool gm_complained_of_memory(void)
{
    return atomic_load(&complained_of_memory);
}

void gm_say(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    put_line(stdout, "", format, arguments);
    va_end(arguments);
}

int gm_finish(int status)
{
    if (fflush(stdout) != 0 || ferror(stdout)) {
        if (errno == EPIPE) {
            return GM_EXIT_PIPE;
        }
        gm_complain("standard output could not be written: %s", strerror(errno));
        return GM_EXIT_FILE;
    }
    return status;
}

enum { NARROWEST = 20, ROOM = 24, LEAST_INDENT = 4 };

/* The width in columns: COLUMNS, else the terminal's; 0 if the output is not a terminal, for lines of any
   length. */
static int columns_of_output(void)
{
    const char *told = getenv("COLUMNS");
    const long columns = told ? strtol(told, NULL, 10) : 0;
    struct winsize size;
    if (columns >= NARROWEST && columns < 10000) {
        return (int)columns;
    }
    if (isatty(STDOUT_FILENO) && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col >= NARROWEST) {
        return size.ws_col;
    }
    return 0;
}

static int letters_of(const char *text, size_t bytes)
{
    int letters = 0;
    for (size_t i = 0; i < bytes; i++) {
        letters += ((unsigned char)text[i] & 0xC0) != 0x80;
    }
    return letters;
}

/* The bytes of the first word; if it does not fit into a line, up to the last comma that fits, else up to
   the first. */
static size_t first_part(const char *text, int available)
{
    const size_t word = strcspn(text, " ");
    size_t part = word;
    for (size_t i = 1; available > 0 && letters_of(text, word) > available && i < word; i++) {
        if (text[i - 1] == ',' && (part == word || letters_of(text, i) <= available)) {
            part = i;
        }
    }
    return part;
}

void gm_print_wrapped(const char *words, int before, int indent)
{
    const bool plain = gm_text_is_plain(words);
    char *const tame = plain ? NULL : strdup(words);
    const char *text = plain ? words : tame ? gm_text_tame(tame) : "";
    const int columns = columns_of_output();
    const int further = columns > 0 && indent > columns - ROOM ? LEAST_INDENT : indent;
    int at = before, blanks = 0; /* before the next word */
    if (before < indent && (columns == 0 || indent + letters_of(text, strcspn(text, " ")) <= columns)) {
        printf("%*s", indent - before, "");
        at = indent;
    } else if (before < indent) {
        at = columns; /* on in the next line */
    }
    while (*text) {
        const size_t bytes = first_part(text, columns - further);
        const int letters = letters_of(text, bytes);
        if (columns > 0 && at + blanks + letters > columns && at > further) {
            printf("\n%*s", further, "");
            at = further;
            blanks = 0;
        }
        printf("%*s%.*s", blanks, "", (int)bytes, text);
        at += blanks + letters;
        text += bytes;
        blanks = (int)strspn(text, " ");
        text += blanks;
    }
    putchar('\n');
    free(tame);
}
