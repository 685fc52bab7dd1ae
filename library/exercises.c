/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Explored lanes as the answer to an exercise of a tour. */
#include <stdlib.h>
#include <string.h>

#include "app/base/files.h"
#include "app/tours/tour.h"
#include "library/handle.h"

/* Returns the step, from 1, if it is an exercise of that tour, which the caller closes; or NULL with a message. */
static const struct gm_tour_step *open_step(geomint *handle, const char *word, size_t step,
                                            struct gm_tour *tour)
{
    char message[GM_MESSAGE];
    struct gm_file file;
    bool unreadable = false;
    *tour = (struct gm_tour){0};
    if (!gm_handle_has(handle, 0) || !gm_handle_given(handle, word, "tour")) {
        return NULL;
    }
    const bool found = gm_tour_find(word, &file, &unreadable, message);
    if (!found || !gm_tour_read(tour, &file, message)) {
        gm_handle_refuse(handle, found || unreadable ? GEOMINT_FILE : GEOMINT_USAGE, message);
        return NULL;
    }
    if (!handle->session || step < 1 || step > tour->count || tour->steps[step - 1].expectation_count == 0) {
        gm_handle_refuse(handle, GEOMINT_USAGE,
                         "an exercise is a step of a tour with expect:, for explored lanes");
        return NULL;
    }
    if (!gm_exercise_is_about(&tour->steps[step - 1], handle->request->scene, message)) {
        gm_handle_refuse(handle, GEOMINT_USAGE, message);
        return NULL;
    }
    return &tour->steps[step - 1];
}

int geomint_grade(geomint *handle, const char *word, size_t number)
{
    char message[GM_MESSAGE];
    struct gm_tour tour;
    const struct gm_call call = gm_call_begin(handle);
    const struct gm_tour_step *step = open_step(handle, word, number, &tour);
    if (step) {
        const bool passed = gm_exercise_passed(
            step, handle->request, (const struct gm_lane *const *)handle->session->lanes, message);
        gm_handle_refuse(handle, passed ? GEOMINT_OK : GEOMINT_CLAIM, message);
    }
    gm_tour_close(&tour);
    return gm_call_end(&call);
}

const char *geomint_answer(geomint *handle, const char *word, size_t number)
{
    struct gm_tour tour;
    const struct gm_call call = gm_call_begin(handle);
    const char *text = NULL;
    if (open_step(handle, word, number, &tour)) {
        free(handle->text);
        text = handle->text = gm_answer_write(&tour, number - 1, handle->request,
                                              (const struct gm_lane *const *)handle->session->lanes);
        if (text && strlen(text) > GM_MOST_ANSWER) {
            text = NULL;
            gm_handle_refuse(handle, GEOMINT_USAGE,
                             "the answer is too long: restart and change less during the run");
        }
    }
    gm_tour_close(&tour);
    gm_call_end(&call);
    return text;
}
