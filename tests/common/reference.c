/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The reader of reference values. */
#include "tests/common/reference.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NAME = 64, WORDS = 5 };

static struct array {
    size_t owner; /* 0: nobody's; else the number of the case, from 1 */
    char name[NAME];
    size_t count;
    double *values;
} * arrays;
static size_t array_count;

static struct named {
    char words[WORDS][NAME];
} * cases;
static size_t case_count;

static void require(bool good, const char *what)
{
    if (!good) {
        fprintf(stderr, "reference values: %s\n", what);
        abort();
    }
}

static void skip_line(FILE *stream)
{
    for (int c = 0; c != EOF && c != '\n'; c = fgetc(stream)) {
    }
}

static void read_case(FILE *stream)
{
    cases = realloc(cases, (case_count + 1) * sizeof *cases);
    require(cases != NULL, "out of memory");
    struct named *named = &cases[case_count++];
    *named = (struct named){0};
    for (size_t i = 0; i < WORDS && fscanf(stream, "%*[ ]%63[^ \n]", named->words[i]) == 1; i++) {
    }
    skip_line(stream);
}

static void read_array(FILE *stream, const char *name)
{
    arrays = realloc(arrays, (array_count + 1) * sizeof *arrays);
    require(arrays != NULL, "out of memory");
    struct array *array = &arrays[array_count++];
    array->owner = case_count;
    snprintf(array->name, sizeof array->name, "%s", name);
    require(fscanf(stream, "%zu", &array->count) == 1, name);
    array->values = malloc(array->count * sizeof *array->values);
    require(array->values != NULL, "out of memory");
    for (size_t i = 0; i < array->count; i++) {
        require(fscanf(stream, "%lf", &array->values[i]) == 1, name);
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
            skip_line(stream);
        } else if (strcmp(name, "case") == 0) {
            read_case(stream);
        } else {
            read_array(stream, name);
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
    free(cases);
    arrays = NULL;
    cases = NULL;
    array_count = case_count = 0;
}

static const double *find(size_t owner, const char *name, size_t count)
{
    for (size_t i = 0; i < array_count; i++) {
        if (arrays[i].owner == owner && strcmp(arrays[i].name, name) == 0) {
            require(arrays[i].count == count, name);
            return arrays[i].values;
        }
    }
    require(false, name);
    return NULL;
}

const double *reference(const char *name, size_t count)
{
    return find(0, name, count);
}

size_t reference_cases(void)
{
    return case_count;
}

const char *reference_word(size_t index, size_t word)
{
    require(index < case_count && word < WORDS, "there is no such case");
    return cases[index].words[word];
}

const double *reference_of(size_t index, const char *name, size_t count)
{
    return find(index + 1, name, count);
}

double reference_number(size_t index, const char *name)
{
    return reference_of(index, name, 1)[0];
}
