/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Checkpoints of `run`. */
#include "app/output/pause.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/output/snapshot.h"
#include "core/schemes.h"
#include "scenes/common/lane_pack.h"

/* A lane's record: its size in bytes, this size not among them, then struct gm_paused, then the
   packed lane. The body of the file is the records of the lanes in order; of those that have not begun the
   size is 0. */

struct record {
    unsigned char *bytes; /* NULL: the lane has not begun */
    size_t size;
};

struct gm_pause {
    const struct gm_request *request;
    const char *from;
    char *identity;
    size_t numbers;
    struct record *records; /* one a lane */
};

/* Every parameter but those that may differ where a run goes on, and the program. */
static char *identify(const struct gm_request *request, size_t numbers)
{
    char *text = NULL, value[GM_TEXT_SIZE];
    size_t size = 0;
    unsigned program = 0;
    const struct gm_scene *scene = request->scene;
    FILE *stream = gm_program_checksum(&program) ? open_memstream(&text, &size) : NULL;
    if (!stream) {
        return NULL;
    }
    fprintf(stream, "run %s, %zu numbers, program %08x\n", scene->mark ? scene->mark : scene->name, numbers,
            program);
    for (size_t i = 0; i < request->count; i++) {
        const struct gm_lane_spec *spec = &request->lanes[i];
        fprintf(stream, "scheme=%s", gm_scheme_word(spec->scheme));
        for (size_t k = 0; k < scene->parameter_count; k++) {
            const struct gm_parameter *row = &scene->parameters[k];
            if (strcmp(row->key, "until") == 0) {
                continue;
            }
            if (row->type == GM_REAL) {
                fprintf(stream, " %s=%.17g", row->key, gm_parameter_get(row, spec->parameters));
            } else {
                fprintf(stream, " %s=%s", row->key,
                        gm_parameter_format(row, spec->parameters, value, sizeof value));
            }
        }
        for (const struct gm_parameter *const *row = spec->scheme->family->parameters; row && *row; row++) {
            fprintf(stream, " %s=%s", (*row)->key,
                    gm_parameter_format(*row, &spec->settings, value, sizeof value));
        }
        fputc('\n', stream);
    }
    if (fclose(stream) != 0) {
        free(text);
        return NULL;
    }
    return text;
}

static size_t head_size(const struct gm_pause *pause)
{
    return 3 * sizeof(double) + 2 * sizeof(uint64_t) + sizeof(int64_t) + pause->numbers * sizeof(double);
}

/* The file's body as records; false if it is not made of them. */
static bool take_apart(struct gm_pause *pause, const struct gm_snapshot *snapshot)
{
    size_t at = 0;
    for (size_t i = 0; i < pause->request->count; i++) {
        uint64_t size = 0;
        if (snapshot->size - at < sizeof size) {
            return false;
        }
        memcpy(&size, snapshot->body + at, sizeof size);
        at += sizeof size;
        if (size > snapshot->size - at || (size > 0 && size < head_size(pause))) {
            return false;
        }
        struct record *record = &pause->records[i];
        if (size > 0) {
            record->bytes = malloc(size);
            if (!record->bytes) {
                return false;
            }
            memcpy(record->bytes, snapshot->body + at, size);
            record->size = size;
        }
        at += size;
    }
    return at == snapshot->size;
}

static bool read_records(struct gm_pause *pause, char *message)
{
    struct gm_snapshot snapshot = {.identity = pause->identity};
    if (!gm_snapshot_read(pause->from, &snapshot, message)) {
        return false;
    }
    const bool good = snapshot.lanes == pause->request->count && take_apart(pause, &snapshot);
    free(snapshot.body);
    if (!good) {
        gm_refuse(message, "%.360s is no checkpoint of these lanes", pause->from);
    }
    return good;
}

struct gm_pause *gm_pause_open(const struct gm_request *request, size_t numbers, const char *from,
                               char *message)
{
    struct gm_pause *pause = calloc(1, sizeof *pause);
    if (pause) {
        *pause = (struct gm_pause){.request = request,
                                   .from = from,
                                   .identity = identify(request, numbers),
                                   .numbers = numbers,
                                   .records = calloc(request->count, sizeof *pause->records)};
    }
    if (!pause || !pause->identity || !pause->records) {
        gm_refuse(message, "not enough memory");
        gm_pause_close(pause);
        return NULL;
    }
    if (from && !read_records(pause, message)) {
        gm_pause_close(pause);
        return NULL;
    }
    return pause;
}

void gm_pause_close(struct gm_pause *pause)
{
    if (!pause) {
        return;
    }
    for (size_t i = 0; pause->records && i < pause->request->count; i++) {
        free(pause->records[i].bytes);
    }
    free(pause->records);
    free(pause->identity);
    free(pause);
}

/* One walk writes and reads what stands before the packed lane. */
static unsigned char *pass(unsigned char *at, void *data, size_t size, bool write)
{
    memcpy(write ? at : data, write ? data : at, size);
    return at + size;
}

static void pass_head(const struct gm_pause *pause, unsigned char *at, struct gm_paused *paused, bool write)
{
    at = pass(at, &paused->seconds, sizeof paused->seconds, write);
    at = pass(at, &paused->rows, sizeof paused->rows, write);
    at = pass(at, &paused->saved, sizeof paused->saved, write);
    at = pass(at, &paused->last_row, sizeof paused->last_row, write);
    at = pass(at, paused->spacing, sizeof paused->spacing, write);
    if (pause->numbers > 0) {
        pass(at, paused->numbers, pause->numbers * sizeof(double), write);
    }
}

bool gm_pause_restore(struct gm_pause *pause, size_t index, struct gm_lane *lane, struct gm_paused *paused,
                      char *message)
{
    const struct record *record = &pause->records[index];
    if (!record->bytes) {
        return true;
    }
    const size_t head = head_size(pause);
    size_t size = record->size - head;
    pass_head(pause, record->bytes, paused, false);
    const double any_time = lane->t0 + 1e300 * lane->run->dt;
    if (!gm_snapshot_unpack(lane, any_time, record->bytes + head, &size) || size != record->size - head) {
        return gm_refuse(message, "%.360s is no checkpoint of these lanes", pause->from);
    }
    if (lane->run->steps > pause->request->lanes[index].steps) {
        return gm_refuse(message, "%.300s has come to t = %.10g already, which is beyond the end asked for",
                         pause->from, lane->run->t);
    }
    return true;
}

bool gm_pause_has_rows(const struct gm_pause *pause)
{
    bool any = false;
    for (size_t i = 0; pause && i < pause->request->count; i++) {
        uint64_t rows = 0;
        if (pause->records[i].bytes) {
            memcpy(&rows, pause->records[i].bytes + sizeof(double), sizeof rows);
        }
        any |= rows > 0;
    }
    return any;
}

bool gm_pause_note(struct gm_pause *pause, size_t index, const struct gm_lane *lane,
                   const struct gm_paused *paused)
{
    struct record *record = &pause->records[index];
    const size_t head = head_size(pause), size = head + gm_lane_pack_size(lane);
    unsigned char *bytes = realloc(record->bytes, size);
    if (!bytes) {
        return false;
    }
    *record = (struct record){bytes, size};
    struct gm_paused copy = *paused;
    pass_head(pause, bytes, &copy, true);
    gm_lane_pack(lane, bytes + head);
    return true;
}

bool gm_pause_write(const struct gm_pause *pause, const char *path, char *message)
{
    struct gm_snapshot snapshot = {.identity = pause->identity, .lanes = (uint32_t)pause->request->count};
    for (size_t i = 0; i < pause->request->count; i++) {
        snapshot.size += sizeof(uint64_t) + pause->records[i].size;
    }
    snapshot.body = malloc(snapshot.size);
    if (!snapshot.body) {
        return gm_refuse(message, "not enough memory");
    }
    unsigned char *at = snapshot.body;
    for (size_t i = 0; i < pause->request->count; i++) {
        uint64_t size = pause->records[i].size;
        at = pass(at, &size, sizeof size, true);
        if (size > 0) {
            at = pass(at, pause->records[i].bytes, size, true);
        }
    }
    const bool good = gm_snapshot_write(path, &snapshot, message);
    free(snapshot.body);
    return good;
}
