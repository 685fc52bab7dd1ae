/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A thread that reads what is typed. */
#include "app/explorer/background/check.h"

#include <stdlib.h>
#include <string.h>

static void find_out(void *self)
{
    struct gm_check *check = self;
    check->read(check->line, &check->fault);
}

static void end(void *self)
{
    (void)self;
}

bool gm_check_knows(struct gm_check *check, gm_line_reader *read, const char *line, int wake,
                    struct gm_typed_fault *fault)
{
    if (check->open && gm_job_is_busy(&check->job)) {
        return false;
    }
    if (!check->line || check->read != read || strcmp(check->line, line) != 0) {
        free(check->line);
        check->line = strdup(line);
        check->read = read;
        check->fault = (struct gm_typed_fault){.at = -1};
        char message[GM_MESSAGE];
        check->open = check->open || gm_job_open(&check->job, find_out, end, check, wake, message);
        if (check->line && check->open) {
            gm_job_begin(&check->job);
            return false;
        }
        gm_refuse(check->fault.sentence, "%s", check->line ? message : "There is not enough memory.");
    }
    *fault = check->fault;
    return true;
}

void gm_check_close(struct gm_check *check)
{
    if (check->open) {
        gm_job_close(&check->job);
    }
    free(check->line);
    *check = (struct gm_check){0};
}
