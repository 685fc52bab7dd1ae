/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What it costs to save the states of Kepler's orbit at every step: the run with its states going to a file,
   beside the same run with nothing saved: at once, in single steps, as whoever looks at each makes them, and
   with the rows made and thrown away.
   Processor time, the system's and the file's completion included; rounds in which all take turns. No test:
   nothing fails here.
   Usage: bench_saving [steps] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "app/data/save.h"
#include "app/words/drive.h"
#include "tests/bench/timing.h"

enum { ROUNDS = 11 };

enum kind { AT_ONCE, SINGLE, TRACED, NPZ, CSV, KINDS };

/* Makes steps up to `steps` in all, and their rows, as `run` does. */
static bool advance(struct gm_drive *drive, struct gm_save *save, enum kind kind, long steps, char *message)
{
    enum { TOGETHER = 1024 };
    static double trace[16 * TOGETHER];
    const struct gm_run *run = drive->lane->run;
    const bool traced = kind == TRACED || kind == NPZ;
    while (gm_drive_goes_on(drive, steps)) {
        const long most = run->steps + (kind == AT_ONCE ? steps : traced ? TOGETHER : 1);
        drive->trace = traced ? trace : NULL;
        bool good = gm_drive_to(drive, most < steps ? most : steps, false, message);
        if (kind == NPZ) {
            good = good && gm_save_rows(save, run, trace,
                                        (size_t)(drive->trace - trace) / (1 + run->problem->n), message);
        } else if (kind == CSV) {
            good = good && gm_save_row(save, run, message);
        }
        if (!good) {
            return false;
        }
    }
    return true;
}

/* Nanoseconds that a step takes. NAN with a sentence on standard error. */
static double measure(const struct gm_request *request, long steps, enum kind kind, const char *path)
{
    const struct gm_rows rows = {.interval = NAN};
    char message[GM_MESSAGE] = "";
    const bool saves = kind >= NPZ;
    struct gm_drive drive = {.lane = gm_request_open_lane(request, 0, message), .request = request};
    const double start = seconds();
    struct gm_save *save = drive.lane && saves ? gm_save_open(path, 1, false, false, message) : NULL;
    const struct gm_run *run = drive.lane ? drive.lane->run : NULL;
    const struct gm_save_size size = {.expected = run ? gm_rows_expected(&rows, run, steps) : 0};
    bool good =
        run &&
        (!saves || (save && gm_save_begin(save, 0, run, &size, message) && gm_save_row(save, run, message)));
    good = good && advance(&drive, save, kind, steps, message) && (!save || gm_save_end(save, "{}", message));
    if (save) {
        good = gm_save_close(save, good, false, message) && good;
    }
    const double took = 1e9 * (seconds() - start) / (double)steps;
    gm_lane_close(drive.lane);
    if (!good) {
        fprintf(stderr, "bench_saving: %s\n", message);
    }
    return good ? took : NAN;
}

int main(int argc, char *argv[])
{
    const long steps = argc > 1 ? strtol(argv[1], NULL, 10) : 1000000;
    static const char *const names[KINDS] = {"at once", "in single steps", "with rows, unsaved", ".npz",
                                             ".csv"};
    char *words[] = {"kepler", "scheme=verlet", "until=1e12"};
    char message[GM_MESSAGE], folder[] = "/tmp/geomint-saving-XXXXXX", path[64];
    double each[KINDS][ROUNDS], ratios[TRACED + 1][KINDS][ROUNDS];
    struct gm_request request;
    if (!gm_request_parse(&request, 3, words, GM_RUN_SCHEMES, message) || !mkdtemp(folder)) {
        fprintf(stderr, "bench_saving: no run or no folder\n");
        return 1;
    }
    for (int round = 0; round < ROUNDS; round++) {
        for (int kind = 0; kind < KINDS; kind++) {
            snprintf(path, sizeof path, "%s/a%s", folder, names[kind]);
            /* text takes so long that a tenth will do */
            each[kind][round] = measure(&request, kind < CSV ? steps : steps / 10, (enum kind)kind, path);
            unlink(path);
        }
        for (int kind = 0; kind < KINDS; kind++) {
            for (int other = 0; other <= TRACED; other++) {
                ratios[other][kind][round] = each[kind][round] / each[other][round];
            }
        }
    }
    rmdir(folder);
    printf(
        "nanoseconds a step of %ld, least and median of %d, and what that is of the same steps unsaved: at once, in "
        "single steps (goal for .npz: 1.3), with rows\n",
        steps, ROUNDS);
    for (int kind = 0; kind < KINDS; kind++) {
        const double middle = median(each[kind], ROUNDS); /* the least is then the first */
        printf("%-19s %8.1f %8.1f   ", names[kind], each[kind][0], middle);
        for (int other = 0; other <= TRACED; other++) {
            printf(" %6.2f", median(ratios[other][kind], ROUNDS));
        }
        printf("\n");
    }
    gm_request_close(&request);
    return 0;
}
