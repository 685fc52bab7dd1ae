/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The scene of a system of forms, for its own files. */
#ifndef GM_SCENES_FORM_FORM_H
#define GM_SCENES_FORM_FORM_H

#include "core/ode/user/forms.h"
#include "scenes/common/system/look.h"

enum { GM_MOST_FORM_OBSERVABLES = 64, GM_MOST_SHOWN_FORMS = 32 };

/* The subject of an observable. */
struct gm_form_subject {
    enum { GM_FORM_ERROR, GM_FORM_CONTRADICTION, GM_FORM_REMAINDER, GM_FORM_OBSERVED, GM_FORM_FACT } what;
    size_t index; /* of a form, of what is observed, or of a fact */
};

struct gm_form_scene {
    struct gm_system_scene of_file; /* first: the scene is its first member */
    struct gm_form_model model;
    const char *path; /* of the file; NULL: none */
    struct gm_form_subject subjects[GM_MOST_FORM_OBSERVABLES];
    const char *shows[GM_MOST_SHOWN_FORMS + 1];        /* words of show= */
    struct gm_form_subject shown[GM_MOST_SHOWN_FORMS]; /* GM_FORM_ERROR: a form of the system */
    size_t show_count;
};

static inline const struct gm_form_scene *gm_form_scene_of(const void *parameters)
{
    return (const struct gm_form_scene *)((const struct gm_system_lane *)parameters)->owner;
}

void gm_form_draw(const struct gm_lane *const *lanes, size_t count, struct gm_picture *picture);

#endif
