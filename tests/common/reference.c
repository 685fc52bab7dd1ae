/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "tests/common/reference.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME = 64 };

static struct array {
    char name[NAME];
    size_t count;
    double *values;
} * arrays;
static size_t array_count;

static void require(bool good, const char *what)
{
    if (!good) {
        fprintf(stderr, "reference values: %s\n", what);
        abort();
    }
}

FILE *reference_file(const char *file)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", GM_REFERENCE, file);
    FILE *stream = fopen(path, "r");
    require(stream != NULL, path);
    return stream;
}

void reference_open(const char *file)
{
    char name[NAME];
    FILE *stream = reference_file(file);
    while (fscanf(stream, " %63s", name) == 1) {
        if (name[0] == '#') {
            for (int c = 0; c != EOF && c != '\n'; c = fgetc(stream)) {
            }
            continue;
        }
        arrays = realloc(arrays, (array_count + 1) * sizeof *arrays);
        require(arrays != NULL, "out of memory");
        struct array *array = &arrays[array_count++];
        snprintf(array->name, sizeof array->name, "%s", name);
        require(fscanf(stream, "%zu", &array->count) == 1, name);
        array->values = malloc(array->count * sizeof *array->values);
        require(array->values != NULL, "out of memory");
        for (size_t i = 0; i < array->count; i++) {
            require(fscanf(stream, "%lf", &array->values[i]) == 1, name);
        }
    }
    fclose(stream);
}

void reference_close(void)
{
    for (size_t i = 0; i < array_count; i++) {
        free(arrays[i].values);
    }
    free(arrays);
    arrays = NULL;
    array_count = 0;
}

const double *reference(const char *name, size_t count)
{
    for (size_t i = 0; i < array_count; i++) {
        if (strcmp(arrays[i].name, name) == 0) {
            require(arrays[i].count == count, name);
            return arrays[i].values;
        }
    }
    require(false, name);
    return NULL;
}
