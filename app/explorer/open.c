/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is open: begun, left, and ended. */
#include "app/explorer/open.h"

#include <stdio.h>
#include <stdlib.h>

#include "render/cells/text.h"

enum { FIRST_SCHEMES = 3, LOOK_SCHEMES = 2 };

/* A new worker, or NULL, which owes its first shot; of a scene, or of one that it makes by that name. */
static bool take_over(struct gm_open *open, struct gm_worker *worker, const struct gm_scene *scene,
                      const char *name)
{
    open->worker = worker;
    open->scene = scene;
    snprintf(open->name, sizeof open->name, "%s",
             !scene         ? name
             : scene->words ? scene->words[0]
                            : scene->name);
    open->shot = NULL;
    open->told = 0;
    open->asked = true;
    open->next_shot = 0;
    open->said[0] = '\0';
    return worker != NULL;
}

/* Keeps a line for the shell. */
static void keep_parting(struct gm_open *open, const char *line)
{
    char *before = open->partings, *longer = NULL;
    if (line[0] && asprintf(&longer, "%sgeomint: %s\n", before ? before : "", line) > 0) {
        open->partings = longer;
        free(before);
    }
}

void gm_open_leave(struct gm_open *open)
{
    char parting[GM_MESSAGE] = "";
    gm_display_finish(open->display);
    if (open->touring) {
        gm_worker_close(open->worker, parting); /* the tour does not outlive it otherwise */
    } else if (open->worker) {
        gm_worker_abandon(open->worker, parting);
    }
    open->worker = NULL;
    open->touring = false;
    keep_parting(open, gm_text_tame(parting));
}

bool gm_open_request(struct gm_open *open, const struct gm_request *request, char *message)
{
    gm_open_leave(open);
    return take_over(open, gm_worker_open(request, open->wake, NULL, message), request->scene, NULL);
}

bool gm_open_line(struct gm_open *open, const char *line, struct gm_typed_fault *fault)
{
    struct gm_request request;
    if (!gm_typed_request(&request, line, FIRST_SCHEMES, fault)) {
        return false;
    }
    struct gm_worker *worker = gm_worker_open(&request, open->wake, NULL, fault->sentence);
    if (worker) {
        gm_open_leave(open);
        take_over(open, worker, request.scene, NULL);
    }
    gm_request_close(&request);
    return worker != NULL;
}

bool gm_open_named(struct gm_open *open, const char *name, bool preview, char *message)
{
    gm_open_leave(open);
    const size_t schemes = preview ? LOOK_SCHEMES : FIRST_SCHEMES;
    return take_over(open, gm_worker_open_named(name, schemes, preview, open->wake, message), NULL, name);
}

void gm_open_take(struct gm_open *open, struct gm_shot *shot)
{
    open->shot = shot;
    open->scene = shot->scene;
    open->asked = false;
}

void gm_open_study(struct gm_open *open)
{
    const struct gm_guide *guide = &open->guide;
    const struct gm_tour_step *step = &guide->tour->steps[guide->step];
    open->studies.shown = GM_STUDY_NONE;
    if (step->study != GM_STUDY_NONE && guide->answered) {
        const struct gm_request *request =
            &guide->tour->steps[gm_tour_first(guide->tour, guide->step)].request;
        gm_studies_open(&open->studies, step->study, request->scene, step->study_words, open->wake);
    }
}

bool gm_open_step(struct gm_open *open, char *message)
{
    const struct gm_guide *guide = &open->guide;
    const struct gm_order first = {
        .kind = GM_ORDER_TOUR, .amount = !guide->answered, .tour = guide->tour, .step = guide->step};
    const struct gm_request *request = &guide->tour->steps[gm_tour_first(guide->tour, guide->step)].request;
    gm_open_leave(open);
    gm_open_study(open);
    open->touring = true;
    return take_over(open, gm_worker_open(request, open->wake, &first, message), request->scene, NULL);
}
