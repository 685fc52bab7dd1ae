/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The places of tours, and the tour that a word means. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "app/base/files.h"
#include "app/tours/tour.h"
#include "core/expression/nearest.h"

static int by_place(const void *a, const void *b)
{
    const struct gm_tour *x = a, *y = b;
    return x->place != y->place ? (x->place > y->place) - (x->place < y->place) : strcmp(x->name, y->name);
}

struct tours {
    struct gm_tour *tours;
    size_t count;
    char *message;
};

static void add_tour(const struct gm_listed *listed, const void *data)
{
    struct tours *list = *(struct tours *const *)data;
    char sentence[GM_MESSAGE];
    struct gm_tour *more = realloc(list->tours, (list->count + 1) * sizeof *more);
    if (!more) {
        return;
    }
    list->tours = more;
    if (gm_tour_read(&list->tours[list->count], listed->file, sentence)) {
        list->count++;
    } else if (!list->message[0]) {
        gm_refuse(list->message, "%s", sentence);
    }
}

struct gm_tour *gm_tours_read(size_t *count, char *message)
{
    struct tours list = {.tours = calloc(1, sizeof *list.tours), .message = message}, *data = &list;
    char folder[GM_MESSAGE] = "";
    message[0] = '\0';
    if (!list.tours) {
        gm_refuse(message, "not enough memory");
    } else if (!gm_files_each(GM_FILE_TOUR, add_tour, &data, folder)) {
        gm_refuse(message, "%s", folder);
    }
    if (list.count > 1) {
        qsort(list.tours, list.count, sizeof *list.tours, by_place);
    }
    *count = list.count;
    return list.tours;
}

void gm_tours_close(struct gm_tour *tours, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        gm_tour_close(&tours[i]);
    }
    free(tours);
}

static const char *name_at(size_t i, const void *data)
{
    return ((const struct gm_tour *)data)[i].name;
}

bool gm_tour_find(const char *word, struct gm_file *file, bool *unreadable, char *message)
{
    *unreadable = false;
    if (strchr(word, '/')) {
        *file = (struct gm_file){0};
        snprintf(file->path, sizeof file->path, "%s", word);
        return true;
    }
    if (gm_file_find(GM_FILE_TOUR, word, file)) {
        return true;
    }
    size_t count = 0;
    struct gm_tour *tours = gm_tours_read(&count, message);
    bool found = false;
    for (size_t i = 0; i < count && !found; i++) {
        found = (strcasecmp(tours[i].title, word) == 0 || strcasecmp(tours[i].name, word) == 0) &&
                gm_file_find(GM_FILE_TOUR, tours[i].name, file);
    }
    const char *near = gm_nearest(word, count, name_at, tours);
    *unreadable = !found && !near && message[0] != '\0';
    if (!found && !*unreadable) {
        gm_refuse(message, "there is no tour \"%.60s\"%s%s", word,
                  near ? "; did you mean " : "; geomint tour lists them, and a file has the ending .tour",
                  near ? near : "");
    }
    gm_tours_close(tours, count);
    return found;
}
