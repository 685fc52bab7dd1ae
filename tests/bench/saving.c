/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What it costs to save the states of Kepler's orbit at every step: the run in single steps, as saving needs
   them, with its states going to a file, beside the same single steps with nothing saved. Processor time, the
   system's and the file's completion included; rounds in which all take turns. No test: nothing fails here.
   Usage: bench_saving [steps] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "app/data/rows.h"
#include "app/data/save.h"
#include "app/request/drive.h"
#include "tests/bench/timing.h"

enum { ROUNDS = 11 };

/* Nanoseconds that a step takes; a path of NULL: nothing is saved. NAN with a sentence on standard error. */
static double measure(const struct gm_request *request, long steps, const char *path)
{
    const struct gm_rows rows = {.interval = NAN};
    char message[GM_MESSAGE] = "";
    struct gm_drive drive = {.lane = gm_request_open_lane(request, 0, message), .request = request};
    const double start = seconds();
    struct gm_save *save = drive.lane && path ? gm_save_open(path, 1, false, false, message) : NULL;
    const struct gm_run *run = drive.lane ? drive.lane->run : NULL;
    const uint64_t expected = run ? gm_rows_expected(&rows, run, steps) : 0;
    bool good = run && (!path || (save && gm_save_begin(save, 0, run, 0, expected, message) &&
                                  gm_save_row(save, run, message)));
    while (good && gm_drive_goes_on(&drive, steps)) {
        const double before = run->t;
        good = gm_drive_to(&drive, save ? gm_rows_next(&rows, run) : run->steps + 1, false, message) &&
               (!save || !gm_rows_due(&rows, run, before) || gm_save_row(save, run, message));
    }
    good = good && (!save || gm_save_end(save, "{}", message));
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
    enum { NONE, NPZ, CSV, KINDS };
    static const char *const endings[KINDS] = {[NPZ] = ".npz", [CSV] = ".csv"};
    char *words[] = {"kepler", "scheme=verlet", "until=1e12"};
    char message[GM_MESSAGE], folder[] = "/tmp/geomint-saving-XXXXXX", path[64];
    double each[KINDS][ROUNDS], ratios[KINDS][ROUNDS];
    struct gm_request request;
    if (!gm_request_parse(&request, 3, words, GM_RUN_SCHEMES, message) || !mkdtemp(folder)) {
        fprintf(stderr, "bench_saving: no run or no folder\n");
        return 1;
    }
    for (int round = 0; round < ROUNDS; round++) {
        for (int kind = 0; kind < KINDS; kind++) {
            snprintf(path, sizeof path, "%s/a%s", folder, endings[kind] ? endings[kind] : "");
            /* text takes so long that a tenth will do */
            each[kind][round] =
                measure(&request, kind < CSV ? steps : steps / 10, endings[kind] ? path : NULL);
            ratios[kind][round] = each[kind][round] / each[NONE][round];
            unlink(path);
        }
    }
    rmdir(folder);
    printf("nanoseconds a step of %ld, least and median of %d, and what that is of the same steps unsaved\n",
           steps, ROUNDS);
    for (int kind = 0; kind < KINDS; kind++) {
        const double middle = median(each[kind], ROUNDS); /* the least is then the first */
        printf("%-16s %8.1f %8.1f   %.2f%s\n", endings[kind] ? endings[kind] : "nothing saved", each[kind][0],
               middle, median(ratios[kind], ROUNDS), kind == NPZ ? " (at most 1.3)" : "");
    }
    gm_request_close(&request);
    return 0;
}
