/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A program that the build runs: writes files of share/ as the array gm_built_in_files.
   Usage: write_files OUT.c share/FOLDER/NAME.ENDING ... */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/expression/reader.h"
#include "core/files/files.h"
#include "core/files/generated.h"

/* Returns "systems/toda.system" for "../share/systems/toda.system". */
static const char *path_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    while (slash && slash > path && slash[-1] != '/') {
        slash--;
    }
    return slash ? slash : path;
}

_Noreturn static void fail(const char *path)
{
    fprintf(stderr, "%s could not be read\n", path);
    exit(EXIT_FAILURE);
}

/* Writes a member with its line of a file, and frees the line; NULL: out of memory. */
static void put_line(FILE *out, const char *path, const char *member, char *line)
{
    if (!line) {
        fail(path);
    }
    fprintf(out, ", .%s = ", member);
    gm_string_put(out, line, strlen(line));
    free(line);
}

static void put_file(FILE *out, const char *given)
{
    const char *path = path_of(given), *name = strrchr(path, '/');
    size_t length = 0;
    enum gm_file_kind kind = GM_FILE_SYSTEM;
    while (kind < GM_FILE_KINDS && !gm_word_ends(path, gm_file_endings[kind])) {
        kind++;
    }
    char *text = kind < GM_FILE_KINDS && name ? gm_input_read(given, &length) : NULL;
    if (!text) {
        fail(given);
    }
    const size_t letters = strlen(name + 1) - (kind == GM_FILE_MESH ? 0 : strlen(gm_file_endings[kind])),
                 described = kind == GM_FILE_MESH ? 0 : length;
    fprintf(out, "{.kind = %d, .path = \"%s\", .name = \"%.*s\"", (int)kind, path, (int)letters, name + 1);
    put_line(out, given, "title", gm_file_title(text, described));
    put_line(out, given, "about", gm_file_line(text, described, "about"));
    fprintf(out, ", .length = %zu, .text = ", length);
    gm_string_put(out, text, length);
    fputs("},\n", out);
    free(text);
}

int main(int argc, char *argv[])
{
    FILE *out = argc > 2 ? fopen(argv[1], "w") : NULL;
    if (!out) {
        return EXIT_FAILURE;
    }
    fputs("#include \"core/files/files.h\"\n\nconst struct gm_built_in gm_built_in_files[] = {\n", out);
    for (int i = 2; i < argc; i++) {
        put_file(out, argv[i]);
    }
    fprintf(out, "};\nconst size_t gm_built_in_count = %d;\n", argc - 2);
    const bool failed = ferror(out);
    return fclose(out) == 0 && !failed ? EXIT_SUCCESS : EXIT_FAILURE;
}
