/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Where tours are, and which one is meant. */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "app/base/share.h"
#include "app/tours/tour.h"
#include "core/expression/nearest.h"

static const char ending[] = ".tour";

/* The folder: that of GEOMINT_TOURS, or beside the installed program, or where it was installed to. */
static const char *tour_folder(char *path, size_t size)
{
    return gm_share_folder("tours", "GEOMINT_TOURS", path, size);
}

static bool has_ending(const char *name)
{
    const size_t length = strlen(name), wanted = sizeof ending - 1;
    return length > wanted && strcmp(name + length - wanted, ending) == 0;
}

static int by_place(const void *a, const void *b)
{
    const struct gm_tour *x = a, *y = b;
    return x->place != y->place ? (x->place > y->place) - (x->place < y->place) : strcmp(x->name, y->name);
}

struct gm_tour *gm_tours_read(size_t *count, char *message)
{
    char folder[4096], path[8192], sentence[GM_MESSAGE];
    struct gm_tour *tours = calloc(1, sizeof *tours);
    *count = 0;
    message[0] = '\0';
    DIR *directory = opendir(tour_folder(folder, sizeof folder));
    if (!tours) {
        gm_refuse(message, "not enough memory");
    } else if (!directory) {
        gm_refuse(message, "there is no folder %.300s with tours; GEOMINT_TOURS can name another", folder);
    }
    for (struct dirent *entry; tours && directory && (entry = readdir(directory));) {
        if (!has_ending(entry->d_name)) {
            continue;
        }
        struct gm_tour *more = realloc(tours, (*count + 1) * sizeof *tours);
        if (!more) {
            break;
        }
        tours = more;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (gm_tour_read(&tours[*count], path, sentence)) {
            (*count)++;
        } else if (!message[0]) {
            gm_refuse(message, "%s", sentence);
        }
    }
    if (directory) {
        closedir(directory);
    }
    if (*count > 1) {
        qsort(tours, *count, sizeof *tours, by_place);
    }
    return tours;
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

bool gm_tour_find(const char *word, char *path, size_t size, bool *file, char *message)
{
    char folder[4096];
    *file = false;
    if (strchr(word, '/') || has_ending(word)) {
        snprintf(path, size, "%s", word);
        return true;
    }
    tour_folder(folder, sizeof folder);
    if (snprintf(path, size, "%s/%s%s", folder, word, ending) < (int)size && access(path, R_OK) == 0) {
        return true;
    }
    size_t count = 0;
    struct gm_tour *tours = gm_tours_read(&count, message);
    bool found = false;
    for (size_t i = 0; i < count && !found; i++) {
        if (strcasecmp(tours[i].title, word) == 0 || strcasecmp(tours[i].name, word) == 0) {
            snprintf(path, size, "%s/%s%s", folder, tours[i].name, ending);
            found = true;
        }
    }
    *file = !found && count == 0 && message[0] != '\0';
    if (!found && !*file) {
        const char *near = gm_nearest(word, count, name_at, tours);
        gm_refuse(message, "there is no tour \"%.60s\"%s%s", word,
                  near ? "; did you mean " : "; geomint tour lists them, and a file has the ending .tour",
                  near ? near : "");
    }
    gm_tours_close(tours, count);
    return found;
}
