/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the states of lanes to a file, by the format of its ending. */
#include "app/data/save.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "app/data/format.h"
#include "core/count.h"
#include "render/clock.h"
#include "render/files/temporary.h"
#include "render/message.h"

struct gm_save {
    struct gm_saving saving;
    const struct gm_data_format *format;
    struct gm_part *part;
    char *path;
    double due; /* of a file that grows: when it is made anew */
};

static const struct gm_data_format *const formats[] = {&gm_data_format_npz, &gm_data_format_csv,
                                                       &gm_data_format_pvd};
enum { FORMATS = GM_COUNT(formats) };

static const struct gm_data_format *format_of(const char *path)
{
    const size_t length = strlen(path);
    for (size_t i = 0; i < FORMATS; i++) {
        const size_t ending = strlen(formats[i]->ending);
        if (length > ending && path[length - ending - 1] != '/' &&
            strcmp(path + length - ending, formats[i]->ending) == 0) {
            return formats[i];
        }
    }
    return NULL;
}

bool gm_save_knows(const char *path, char *message)
{
    if (format_of(path)) {
        return true;
    }
    return gm_refuse(message, "%.300s cannot be saved: no ending of .npz, .csv, .pvd", path);
}

static bool complain(const struct gm_save *save, char *message)
{
    return gm_refuse(message, "%.360s could not be written: %s", save->path, strerror(errno));
}

struct gm_save *gm_save_open(const char *path, size_t lanes, bool go_on, char *message)
{
    struct gm_save *save = calloc(1, sizeof *save);
    struct gm_saved *saved = calloc(lanes, sizeof *saved);
    char *name = strdup(path);
    if (!save || !saved || !name || !gm_temporary_fits(path)) {
        gm_refuse(message,
                  save && saved && name ? "%.360s is no file that can be replaced" : "not enough memory",
                  path);
        free(save);
        free(saved);
        free(name);
        return NULL;
    }
    *save = (struct gm_save){
        .saving = {.path = name, .lanes = saved, .count = lanes}, .format = format_of(path), .path = name};
    save->saving.part = save->part = gm_part_open(path, go_on, message);
    if (!save->part) {
        gm_save_close(save, false, true, message);
        return NULL;
    }
    gm_temporary_sweep(path);
    return save;
}

static struct gm_saved *present(struct gm_save *save)
{
    return &save->saving.lanes[save->saving.begun - 1];
}

bool gm_save_begin(struct gm_save *save, size_t index, const struct gm_run *run, uint64_t rows, char *message)
{
    struct gm_saved *lane = &save->saving.lanes[save->saving.begun++];
    *lane = (struct gm_saved){.index = index, .rows = rows, .members = run->problem->m};
    lane->count = gm_quantities_beside_time(run, lane->quantities);
    size_t longest = 1;
    for (size_t i = 0; i < lane->count; i++) {
        lane->sizes[i] = gm_quantity_size(run, &lane->quantities[i]);
        longest = lane->quantities[i].derive && lane->sizes[i] > longest ? lane->sizes[i] : longest;
    }
    lane->scratch = malloc(longest * sizeof *lane->scratch);
    const char *reason = save->format->refuse ? save->format->refuse(&save->saving) : NULL;
    if (reason) {
        return gm_refuse(message, "%.240s cannot be saved: %s", save->path, reason);
    }
    errno = ENOMEM;
    return (lane->scratch && save->format->begin(&save->saving, lane, run)) || complain(save, message);
}

static bool join(FILE *file, const void *context)
{
    const struct gm_save *save = context;
    return save->format->join(&save->saving, file);
}

static bool publish(const struct gm_save *save)
{
    return gm_temporary_make(save->path, join, save);
}

static bool flush(struct gm_saved *lane, bool sync)
{
    bool good = true;
    for (size_t i = 0; i < GM_COLUMNS; i++) {
        good = good && (!lane->columns[i].buffer || gm_column_flush(&lane->columns[i], sync));
    }
    return good;
}

bool gm_save_row(struct gm_save *save, const struct gm_run *run, char *message)
{
    enum { SECONDS = 1 }; /* between two makings of a file that grows */
    struct gm_saved *lane = present(save);
    if (!save->format->row(&save->saving, lane, run)) {
        return complain(save, message);
    }
    lane->rows++;
    if (save->format->grows && gm_clock_seconds() >= save->due) {
        if (!flush(lane, false) || !publish(save)) {
            return complain(save, message);
        }
        save->due = gm_clock_seconds() + SECONDS;
    }
    return true;
}

bool gm_save_sync(struct gm_save *save, uint64_t *rows, char *message)
{
    *rows = present(save)->rows;
    return flush(present(save), true) || complain(save, message);
}

static bool finish(struct gm_saved *lane)
{
    bool good = true;
    for (size_t i = 0; i < GM_COLUMNS; i++) {
        good = gm_column_close(&lane->columns[i]) && good;
    }
    free(lane->scratch);
    lane->scratch = NULL;
    return good;
}

bool gm_save_end(struct gm_save *save, const char *meta, char *message)
{
    struct gm_saved *lane = present(save);
    errno = ENOMEM;
    lane->meta = strdup(meta);
    const bool whole = lane->meta != NULL;
    return (finish(lane) && whole) || complain(save, message);
}

bool gm_save_close(struct gm_save *save, bool complete, bool keep, char *message)
{
    for (size_t i = 0; i < save->saving.begun; i++) {
        finish(&save->saving.lanes[i]);
    }
    const bool good = !complete || save->saving.begun == 0 || publish(save) || complain(save, message);
    for (size_t i = 0; i < save->saving.begun; i++) {
        free(save->saving.lanes[i].meta);
    }
    gm_part_close(save->part, !keep);
    free(save->saving.lanes);
    free(save->path);
    free(save);
    return good;
}
