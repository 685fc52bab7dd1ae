/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_STUDIES_KINDS_SWEEP_H
#define GM_APP_STUDIES_KINDS_SWEEP_H

#include "app/grid/sweep.h"

/* A sweep that is looked at while it is made: its table is a file without a name. */
struct gm_sweep_study {
    struct gm_sweep sweep;
    int table;
    struct gm_sweep_chart *chart; /* NULL: no row is there */
};

/* Of words as of the command, with --measure LIST among them. What follows is as in app/grid/kinds/study.h. */
bool gm_sweep_study_open(struct gm_sweep_study *study, const struct gm_arguments *arguments, char *message);
bool gm_sweep_study_measure(struct gm_sweep_study *study, const struct gm_listener *listener, char *message);
void gm_sweep_study_draw(const struct gm_sweep_study *study, struct gm_picture *picture);
bool gm_sweep_study_write(const struct gm_sweep_study *study, const char *path);
void gm_sweep_study_close(struct gm_sweep_study *study);

#endif
