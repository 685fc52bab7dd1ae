/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_BACKGROUND_CHECK_H
#define GM_APP_EXPLORER_BACKGROUND_CHECK_H

#include "app/explorer/background/job.h"
#include "app/words/typed.h"

/* What is wrong with a line while it is typed: found out beside the screen, as a sum may have many terms. */

/* Whether a line could be read, and nothing is kept of it. */
typedef bool gm_line_reader(const char *line, struct gm_typed_fault *fault);

struct gm_check { /* {0} has found out nothing */
    struct gm_job job;
    bool open;
    gm_line_reader *read;
    char *line; /* that was asked about last */
    struct gm_typed_fault fault;
};

/* Whether it is known what is wrong with the line; else that is found out, unless another line still is, and
   `wake` is written to at the end: then is the time to ask again. */
bool gm_check_knows(struct gm_check *check, gm_line_reader *read, const char *line, int wake,
                    struct gm_typed_fault *fault);
void gm_check_close(struct gm_check *check);

#endif
