/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From the states of lanes to a file, by the format of its ending. */
#include "app/data/save.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/data/format.h"
#include "core/basics.h"
#include "core/expression/reader.h"
#include "render/clock.h"
#include "render/files/deflate.h"
#include "render/files/temporary.h"
#include "render/message.h"

struct gm_save {
    struct gm_saving saving;
    const struct gm_data_format *format;
    struct gm_part *part;
    double due;   /* the time of the next writing of a growing file */
    int cut;      /* errno of the write after which there are no more rows, or 0 */
    size_t lanes; /* number of the started lanes that the file has */
    struct gm_saved saved[];
};

static const struct gm_data_format *const formats[] = {&gm_data_format_npz, &gm_data_format_csv,
                                                       &gm_data_format_pvd, &gm_data_format_xdmf};
enum { FORMATS = GM_COUNT(formats) };

static const struct gm_data_format *format_of(const char *path)
{
    for (size_t i = 0; i < FORMATS; i++) {
        if (gm_word_ends(basename(path), formats[i]->ending)) {
            return formats[i];
        }
    }
    return NULL;
}

bool gm_save_fits(const char *path, const struct gm_request *request, char *message)
{
    const struct gm_data_format *format = format_of(path);
    if (!format) {
        return gm_refuse(message, "%.300s cannot be saved: no ending of .npz, .csv, .pvd, .xdmf%s", path,
                         gm_word_ends(basename(path), ".vtu") ? "; .pvd has a .vtu file for each row" : "");
    }
    const bool compares = format->refuse && request->count > 1;
    struct gm_lane *first = compares ? gm_request_open_lane(request, 0, message) : NULL;
    const char *reason = NULL;
    for (size_t i = 1; first && i < request->count && !reason; i++) {
        struct gm_lane *lane = gm_request_open_lane(request, i, message);
        reason = lane ? format->refuse(first->run, lane->run)
                      : NULL; /* a lane that cannot be opened gives its reason later */
        gm_lane_close(lane);
    }
    gm_lane_close(first);
    return !reason || gm_refuse(message, "%.240s cannot be saved: %s", path, reason);
}

static bool complain(const struct gm_save *save, int why, char *message)
{
    return gm_refuse(message, "%.360s could not be written: %s", save->saving.path,
                     why == EILSEQ ? "its rows so far are damaged; run it without --continue"
                                   : strerror(why));
}

struct gm_save *gm_save_open(const char *path, size_t lanes, bool go_on, bool resumable, char *message)
{
    struct gm_save *save = calloc(1, sizeof *save + lanes * sizeof *save->saved);
    char *folder = strndup(path, (size_t)(strrchr(path, '.') - path));
    if (!save || !folder) {
        gm_refuse(message, "not enough memory");
    } else if (gm_temporary_can_replace(path, message)) {
        gm_deflate(); /* without it the program ends before there is a file */
        save->part = gm_part_open(path, go_on, message);
    }
    if (!save || !save->part) {
        free(save);
        free(folder);
        return NULL;
    }
    save->saving = (struct gm_saving){.path = path,
                                      .folder = folder,
                                      .part = save->part,
                                      .lanes = save->saved,
                                      .count = lanes,
                                      .kept = go_on};
    save->format = format_of(path);
    gm_temporary_sweep(path);
    if (resumable && !go_on && !gm_part_sign(save->part)) {
        complain(save, errno, message);
        gm_save_close(save, false, false, message);
        return NULL;
    }
    return save;
}

uint64_t gm_save_identity(const struct gm_save *save)
{
    return gm_part_identity(save->part);
}

static struct gm_saved *present(struct gm_save *save)
{
    return &save->saving.lanes[save->saving.begun - 1];
}

/* Frees a lane's memory and closes its file, but, unless `whole`, keeps the parts of the complete file. */
static void release(struct gm_saved *lane, bool whole)
{
    for (size_t i = 0; i < GM_COLUMNS; i++) {
        gm_column_close(&lane->columns[i]);
    }
    free(lane->scratch);
    lane->scratch = NULL;
    gm_bytes_close(&lane->file);
    if (whole) {
        gm_npz_close(&lane->layout.npz);
        free(lane->meta);
    }
}

/* Nothing of a lane could be written: the file will have those before it. */
static bool leave_out(struct gm_save *save, char *message)
{
    struct gm_saved *lane = present(save);
    const int why = lane->file.why;
    lane->file.why = 0;
    save->cut = 0;
    if (!save->saving.kept && save->saving.begun > 1) {
        release(lane, true);
        gm_part_drop(save->part, lane->index, false);
        save->saving.begun--;
        save->cut = why;
    }
    return complain(save, why, message);
}

bool gm_save_begin(struct gm_save *save, size_t index, const struct gm_run *run,
                   const struct gm_save_size *size, char *message)
{
    struct gm_saved *lane = &save->saving.lanes[save->saving.begun++];
    *lane = (struct gm_saved){.index = index,
                              .rows = size->rows,
                              .members = run->problem->m,
                              .file.file = -1,
                              .meta_size = size->meta};
    lane->count = gm_quantities_beside_time(run, save->format->pictures, lane->quantities);
    size_t longest = 1;
    for (size_t i = 0; i < lane->count; i++) {
        lane->sizes[i] = gm_quantity_size(run, &lane->quantities[i]);
        longest = lane->quantities[i].derive && lane->sizes[i] > longest ? lane->sizes[i] : longest;
    }
    lane->scratch = malloc(longest * sizeof *lane->scratch);
    if (lane->scratch) {
        save->format->begin(&save->saving, lane, run, size->expected);
    } else {
        lane->file.why = ENOMEM;
    }
    return lane->file.why == 0 || leave_out(save, message);
}

static bool list(FILE *file, const void *context)
{
    const struct gm_save *save = context;
    return save->format->list(&save->saving, file);
}

/* Ends a lane after a failed write, mostly for lack of room: its written rows stay, if there are any. */
static bool give_up(struct gm_save *save, char *message)
{
    struct gm_saved *lane = present(save);
    const int why = lane->file.why;
    if (!save->saving.kept && save->cut == 0) {
        gm_columns_flush(lane->columns, GM_COLUMNS);
        save->format->cut(&save->saving, lane);
        save->cut = why;
    }
    if (lane->rows == 0) {
        return leave_out(save, message);
    }
    lane->file.why = 0;
    return complain(save, why, message);
}

void gm_save_keep(struct gm_save *save)
{
    save->saving.kept = true;
}

bool gm_save_is_cut(const struct gm_save *save)
{
    return save->cut != 0;
}

bool gm_save_row(struct gm_save *save, const struct gm_run *run, char *message)
{
    enum { SECONDS = 1 }; /* between two makings of a file that grows */
    struct gm_saved *lane = present(save);
    save->format->row(&save->saving, lane, run);
    if (lane->file.why != 0) {
        return give_up(save, message);
    }
    lane->rows++;
    if (save->format->list && gm_clock_seconds() >= save->due) {
        gm_bytes_note(&lane->file, gm_temporary_make(save->saving.path, list, save));
        save->due = gm_clock_seconds() + SECONDS;
    }
    return lane->file.why == 0 || give_up(save, message);
}

bool gm_save_takes_many(const struct gm_save *save)
{
    return save->format->rows && save->saving.lanes[save->saving.begun - 1].plain;
}

bool gm_save_rows(struct gm_save *save, const struct gm_run *run, const double *rows, size_t count,
                  char *message)
{
    save->format->rows(&save->saving, present(save), run, rows, count);
    return present(save)->file.why == 0 || give_up(save, message);
}

bool gm_save_sync(struct gm_save *save, uint64_t *rows, char *message)
{
    struct gm_saved *lane = present(save);
    *rows = lane->rows;
    gm_columns_flush(lane->columns, GM_COLUMNS);
    gm_bytes_sync(&lane->file);
    return lane->file.why == 0 || give_up(save, message);
}

bool gm_save_end(struct gm_save *save, const char *meta, char *message)
{
    struct gm_saved *lane = present(save);
    if (lane->file.file < 0) {
        return true;
    }
    gm_columns_flush(lane->columns, GM_COLUMNS);
    if (lane->file.why != 0) {
        return give_up(save, message);
    }
    lane->size = lane->columns[0].place;
    lane->meta = strdup(meta);
    gm_bytes_note(&lane->file, lane->meta);
    if (lane->meta && save->format->end) {
        save->format->end(&save->saving, lane);
    }
    if (lane->file.why != 0) {
        return leave_out(save, message);
    }
    release(lane, false);
    return true;
}

/* Appends the lanes to each other in `file`, which has the first one if `there`. Without room for all of
   them, it has the first ones. */
static void join(struct gm_save *save, struct gm_bytes *file, bool there)
{
    const struct gm_saving *saving = &save->saving;
    uint64_t place = 0;
    for (save->lanes = 0; save->lanes < saving->begun; save->lanes++) {
        const struct gm_saved *lane = &saving->lanes[save->lanes];
        if (save->lanes > 0 || !there) {
            uint32_t crc = 0;
            struct gm_bytes source = gm_bytes_of(gm_part_file(save->part, lane->index, false));
            if (saving->kept) {
                gm_bytes_copy(&source, 0, lane->size, file, place, &crc);
            } else {
                gm_bytes_move(&source, 0, lane->size, file, place);
            }
            gm_bytes_close(&source);
        }
        if (file->why != 0) {
            break;
        }
        if (save->lanes > 0 && !saving->kept) {
            gm_part_drop(save->part, lane->index, false);
        }
        place += lane->size;
    }
    if (file->why != 0 && !saving->kept && save->lanes > 0) {
        save->cut = file->why;
        file->why = 0;
    }
    if (save->format->finish) {
        save->format->finish(saving, save->lanes, file);
    } else {
        gm_bytes_truncate(file, place);
    }
}

static bool copy(FILE *file, const void *context)
{
    struct gm_save *const *save = context;
    struct gm_bytes bytes = gm_bytes_of(fileno(file));
    join(*save, &bytes, false);
    errno = bytes.why;
    return bytes.why == 0;
}

/* Writes the list of all rows; without room for it, the last rows are dropped. Without a list renames the first lane's
   file to the file, or, if that must stay for a resumed run, writes a copy. */
static bool publish(struct gm_save *save, bool keep)
{
    while (save->format->list && !gm_temporary_make(save->saving.path, list, save)) {
        const int why = errno;
        const bool full = why == ENOSPC || why == EFBIG || why == EDQUOT;
        if (!full || save->saving.kept || !save->format->drop(&save->saving, present(save))) {
            errno = why;
            return false;
        }
        save->cut = why;
    }
    if (save->format->list) {
        return true;
    }
    if (keep) {
        return gm_temporary_make(save->saving.path, copy, &save);
    }
    const size_t first = save->saving.lanes[0].index;
    struct gm_bytes file = gm_bytes_of(gm_part_file(save->part, first, false));
    join(save, &file, true);
    gm_bytes_sync(&file);
    return gm_bytes_close(&file) && gm_part_publish(save->part, first, save->saving.path);
}

/* Refuses with the number of rows of an incomplete file. */
static bool tell_cut(const struct gm_save *save, char *message)
{
    const struct gm_saved *last = &save->saving.lanes[save->saving.begun - 1];
    const char *why = strerror(save->cut);
    if (!save->format->list && save->lanes < save->saving.begun) {
        return gm_refuse(message, "%.300s has the first %zu of %zu lanes only: %s", save->saving.path,
                         save->lanes, save->saving.begun, why);
    }
    if (save->saving.count > 1) {
        return gm_refuse(message, "%.300s ends after %" PRIu64 " rows of lane %zu: %s", save->saving.path,
                         last->rows, last->index, why);
    }
    return gm_refuse(message, "%.300s ends after %" PRIu64 " rows: %s", save->saving.path, last->rows, why);
}

bool gm_save_close(struct gm_save *save, bool complete, bool keep, char *message)
{
    const bool makes = (complete || save->cut != 0) && save->saving.begun > 0;
    const bool whole =
        !makes || ((publish(save, keep && save->saving.kept) || complain(save, errno, message)) &&
                   (save->cut == 0 || tell_cut(save, message)));
    for (size_t i = 0; i < save->saving.begun; i++) {
        release(&save->saving.lanes[i], true);
    }
    gm_part_close(save->part, !keep || !save->saving.kept);
    free(save->saving.folder);
    free(save);
    return whole;
}

/* ---- the choice of the steps that have a row ---- */

/* Returns true if rows follow the time, and not every step has one. */
static bool is_by_time(const struct gm_rows *rows, const struct gm_run *run)
{
    return rows->every == 0 && !isnan(rows->interval) &&
           (run->scheme->family->adaptive || rows->interval > fabs(run->dt));
}

/* The step next to the first multiple of the interval whose step is not before `step`. */
static double step_from(const struct gm_rows *rows, const struct gm_run *run, double step)
{
    const double steps = rows->interval / fabs(run->dt); /* more than 1 */
    double k = fmax(0, ceil((step - 0.5) / steps) - 1);
    while (round(k * steps) < step) {
        k++;
    }
    return round(k * steps);
}

bool gm_rows_all(const struct gm_rows *rows, const struct gm_run *run)
{
    return !is_by_time(rows, run) && rows->every < 2;
}

int64_t gm_rows_next(const struct gm_rows *rows, const struct gm_run *run)
{
    const int64_t next = run->steps + 1, far = INT64_C(1) << 40;
    if (!is_by_time(rows, run)) {
        return rows->every < 2 ? next : run->steps - run->steps % rows->every + rows->every;
    }
    if (run->scheme->family->adaptive) {
        return next;
    }
    return (int64_t)fmin(step_from(rows, run, (double)next), (double)(next + far));
}

bool gm_rows_due(const struct gm_rows *rows, const struct gm_run *run, double before)
{
    if (!is_by_time(rows, run)) {
        return rows->every < 2 || run->steps % rows->every == 0;
    }
    if (run->scheme->family->adaptive) {
        return floor(run->t / rows->interval) != floor(before / rows->interval);
    }
    return step_from(rows, run, (double)run->steps) == (double)run->steps;
}

uint64_t gm_rows_expected(const struct gm_rows *rows, const struct gm_run *run, int64_t last)
{
    if (run->scheme->family->adaptive || last < 0) {
        return 0;
    }
    if (!is_by_time(rows, run)) {
        const int64_t every = rows->every < 2 ? 1 : rows->every;
        return (uint64_t)(last / every) + (last % every != 0) + 1;
    }
    const double steps = rows->interval / fabs(run->dt), most = (double)(1L << 50);
    const double k = fmin(floor(((double)last + 0.5) / steps), most);
    return (uint64_t)k + (round(k * steps) != (double)last) + 1;
}

/* ---- the state of a field on a line, as CSV ---- */

/* The quantities of the nodes, the coordinate first; returns their number, 0 if the nodes are not on a
   line. */
static size_t list_nodes(const struct gm_run *run, struct gm_quantity chosen[GM_QUANTITIES])
{
    struct gm_quantity all[GM_QUANTITIES];
    const size_t count = gm_quantities(run, all);
    size_t used = 1;
    bool on_line = false;
    for (size_t i = 0; i < count; i++) {
        if (all[i].support != GM_ON_NODES) {
            continue;
        }
        if (all[i].axis == 0) {
            chosen[used++] = all[i];
        } else {
            chosen[0] = all[i];
            on_line = all[i].width == 1;
        }
    }
    return on_line ? used : 0;
}

bool gm_profile_is_there(const struct gm_run *run)
{
    struct gm_quantity quantities[GM_QUANTITIES];
    return list_nodes(run, quantities) > 0;
}

void gm_profile_columns(const struct gm_run *run, FILE *stream)
{
    struct gm_quantity quantities[GM_QUANTITIES];
    const size_t count = list_nodes(run, quantities);
    fputc('x', stream);
    for (size_t i = 1; i < count; i++) {
        fprintf(stream, ",%s", quantities[i].name);
    }
}

bool gm_profile_write(const struct gm_run *run, const char *front, FILE *stream)
{
    struct gm_quantity quantities[GM_QUANTITIES];
    const double *values[GM_QUANTITIES];
    const size_t count = list_nodes(run, quantities), nodes = quantities[0].count;
    double *scratch = malloc(count * nodes * sizeof *scratch);
    if (!scratch) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        values[i] = gm_quantity_values(run, &quantities[i], scratch + i * nodes);
    }
    for (size_t k = 0; k < nodes; k++) {
        fputs(front, stream);
        for (size_t i = 0; i < count; i++) {
            fprintf(stream, ",%.17g", values[i][k]);
        }
        fputc('\n', stream);
    }
    free(scratch);
    return true;
}
