/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_EXPLORER_VIEW_STUDIES_H
#define GM_APP_EXPLORER_VIEW_STUDIES_H

#include "app/explorer/background/study.h"
#include "app/explorer/surface/sheet.h"
#include "app/runs/shot.h"

/* The background studies of the explorer, one of each kind, and which of them is on the screen. */

struct gm_studies {
    struct gm_study *studies[GM_STUDY_COUNT];
    struct gm_study_look *looks[GM_STUDY_COUNT];   /* the last ones taken; NULL: none yet */
    const struct gm_scene *scenes[GM_STUDY_COUNT]; /* that were open when they began: it may be gone */
    enum gm_study_kind shown;                      /* GM_STUDY_NONE: the scene is */
    struct gm_painting painting;                   /* the shown picture */
    char notice[GM_MESSAGE];                       /* what could not be done; "" after the next key */
};

void gm_studies_close(struct gm_studies *studies);

/* Shows a study of a scene; starts it unless one of the same words is there already. False if it cannot be made: the
   notice says why. */
bool gm_studies_open(struct gm_studies *studies, enum gm_study_kind kind, const struct gm_scene *scene,
                     const char *words, int wake);

/* The same for the scene as it is set now, by the key: w work-precision, m the stability map. */
void gm_studies_begin(struct gm_studies *studies, int key, const struct gm_shot *shot, int wake);

/* The scene with what the user has set, as the words of a study; malloc'ed, NULL: no memory. */
char *gm_studies_words(const struct gm_shot *shot);

/* The words of the run that the shown study has at a cell of its picture, the scene first; malloc'ed, NULL:
   there is none. */
char *gm_studies_pick(const struct gm_studies *studies, enum gm_blocks blocks, int column, int row);

/* What a key does while a study is shown; false: it is for others. */
bool gm_studies_press(struct gm_studies *studies, int key, enum gm_theme theme);

/* Takes what is new; true if the screen has to be composed again. */
bool gm_studies_look(struct gm_studies *studies);

/* The picture of the shown study over the sheet. */
void gm_studies_draw(const struct gm_sheet *sheet, struct gm_studies *studies);
/* The line on how far the shown study is. */
void gm_studies_status(const struct gm_studies *studies, char *text, size_t size);
/* The line on studies of this scene that go on unseen, or the notice; "" if there is nothing to say. */
void gm_studies_news(const struct gm_studies *studies, const struct gm_scene *scene, char *text, size_t size);

#endif
