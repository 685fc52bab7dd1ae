/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What is open: a scene, or a step of a tour with its study. */
#include "app/explorer/events.h"

#include <stdio.h>
#include <stdlib.h>

#include "render/cells/text.h"

enum { FIRST_SCHEMES = 3, LOOK_SCHEMES = 2 };

/* A new worker owes its first shot. */
static void expect_shot(struct gm_explorer *explorer)
{
    explorer->shot = NULL;
    explorer->told = 0;
    explorer->asked = true;
    explorer->next_shot = 0;
}

bool gm_explorer_open_request(struct gm_explorer *explorer, const struct gm_request *request,
                              const struct gm_order *first)
{
    explorer->worker =
        gm_worker_open(request, explorer->face.theme, explorer->wake, first, explorer->message);
    explorer->scene = request->scene;
    expect_shot(explorer);
    return explorer->worker != NULL;
}

/* Keeps a line for the shell. */
static void keep_parting(struct gm_explorer *explorer, const char *line)
{
    char *before = explorer->partings, *longer = NULL;
    if (line[0] && asprintf(&longer, "%sgeomint: %s\n", before ? before : "", line) > 0) {
        explorer->partings = longer;
        free(before);
    }
}

void gm_explorer_close_worker(struct gm_explorer *explorer)
{
    char parting[GM_MESSAGE];
    gm_worker_close(explorer->worker, parting);
    explorer->worker = NULL;
    keep_parting(explorer, gm_text_tame(parting));
}

static void abandon(struct gm_explorer *explorer)
{
    char parting[GM_MESSAGE];
    gm_display_finish(&explorer->display); /* it may be painting a picture of this worker's */
    if (explorer->touring) {
        gm_explorer_close_worker(explorer); /* the tour does not outlive it otherwise */
    } else if (explorer->worker) {
        gm_worker_abandon(explorer->worker, parting);
        keep_parting(explorer, parting);
    }
    explorer->worker = NULL;
    explorer->touring = false;
    explorer->scene = NULL;
    explorer->said[0] = '\0';
    expect_shot(explorer);
}

void gm_explorer_open_scene(struct gm_explorer *explorer, const struct gm_scene *scene, bool preview)
{
    abandon(explorer);
    explorer->worker = gm_worker_open_scene(scene, preview ? LOOK_SCHEMES : FIRST_SCHEMES, preview,
                                            explorer->face.theme, explorer->wake, explorer->message);
    explorer->scene = scene;
    if (!explorer->worker) {
        gm_explorer_leave(explorer, GM_EXIT_USAGE);
    }
}

static void begin_study(struct gm_explorer *explorer)
{
    const struct gm_guide *guide = &explorer->guide;
    const struct gm_tour_step *step = &guide->tour->steps[guide->step];
    explorer->studies.shown = GM_STUDY_NONE;
    if (step->study != GM_STUDY_NONE && guide->answered) {
        gm_studies_open(&explorer->studies, step->study, step->study_words, explorer->wake);
    }
}

bool gm_explorer_open_step(struct gm_explorer *explorer)
{
    const struct gm_guide *guide = &explorer->guide;
    const struct gm_order first = {
        .kind = GM_ORDER_TOUR, .amount = !guide->answered, .tour = guide->tour, .step = guide->step};
    abandon(explorer);
    begin_study(explorer);
    explorer->at_start = explorer->kept = false;
    explorer->look_due = -1;
    explorer->face.parameter = 0;
    explorer->touring = true;
    return gm_explorer_open_request(
        explorer, &guide->tour->steps[gm_tour_first(guide->tour, guide->step)].request, &first);
}

void gm_explorer_press_in_tour(struct gm_explorer *explorer, int key)
{
    if (!explorer->guide.tour) {
        return;
    }
    explorer->dirty = true;
    switch (gm_guide_press(&explorer->guide, key)) {
    case GM_GUIDE_OPEN:
        if (!gm_explorer_open_step(explorer)) {
            gm_explorer_leave(explorer, GM_EXIT_USAGE);
        }
        break;
    case GM_GUIDE_RUN:
        begin_study(explorer);
        gm_worker_order(explorer->worker, (struct gm_order){.kind = GM_ORDER_RUN});
        break;
    case GM_GUIDE_END:
        break;
    }
}
