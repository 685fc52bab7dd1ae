/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The view of space: projection by parallel light, depth, and points hidden by ellipsoids. */
#include "scenes/common/camera.h"

#include <math.h>
#include <string.h>

#include "core/functions/functions.h"
#include "core/linear/vectors.h"

/* The box is shown with this factor of room for names. */
static const double around = 1.1;

bool gm_camera_has(const char *key)
{
    static const struct gm_parameter rows[] = {GM_CAMERA_ROWS(
        struct { struct gm_camera camera; }, camera)};
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        if (strcmp(rows[i].key, key) == 0) {
            return true;
        }
    }
    return false;
}

void gm_space_turn(struct gm_space *space, const struct gm_camera *camera, double t)
{
    const double azimuth = fmod(camera->azimuth + camera->turn * t, 360) * M_PI / 180;
    const double elevation = camera->elevation * M_PI / 180;
    const double ca = gm_cos(azimuth), sa = gm_sin(azimuth), ce = gm_cos(elevation), se = gm_sin(elevation);
    memcpy(space->right, (const double[]){-sa, ca, 0}, sizeof space->right);
    memcpy(space->up, (const double[]){-se * ca, -se * sa, ce}, sizeof space->up);
    memcpy(space->towards, (const double[]){ce * ca, ce * sa, se}, sizeof space->towards);
}

void gm_space_fit(struct gm_space *space, const struct gm_camera *camera, double reach,
                  struct gm_panel *panel)
{
    double centre[3], half[3], middle[2];
    for (size_t k = 0; k < 3; k++) {
        centre[k] = reach > 0 ? 0 : 0.5 * (space->low[k] + space->high[k]);
        half[k] = 0.5 * (space->high[k] - space->low[k]);
    }
    const double ce = fabs(space->up[2]), se = fabs(space->towards[2]), round = gm_hypot(half[0], half[1]);
    const double width = reach > 0 ? reach : round;
    const double height = reach > 0 ? reach : se * round + ce * half[2];
    const double deep = reach > 0 ? reach : ce * round + se * half[2];
    const double depth = gm_space_place(space, centre, middle);
    space->back = depth - deep;
    space->front = depth + deep;
    const double across = around * width / camera->zoom, along = around * height / camera->zoom;
    panel->x = (struct gm_axis){.label = "", .low = middle[0] - across, .high = middle[0] + across};
    panel->y = (struct gm_axis){.label = "", .low = middle[1] - along, .high = middle[1] + along};
    panel->equal = true;
}

double gm_space_place(const struct gm_space *space, const double point[3], double place[2])
{
    place[0] = gm_dot(space->right, point);
    place[1] = gm_dot(space->up, point);
    return gm_dot(space->towards, point);
}

double gm_space_nearness(const struct gm_space *space, double depth)
{
    const double part = (depth - space->back) / (space->front - space->back);
    return part >= 0 && part <= 1 ? part : part > 1 ? 1 : 0;
}

/* The eye is seen from the point P along P + s d, s > 0, and the ellipsoid is x.x = 1 in units of its half
   axes: s is a root of d.d s^2 + 2 P.d s + P.P - 1. */
bool gm_space_hides(const struct gm_space *space, const double point[3], const struct gm_ellipsoid *on)
{
    for (size_t i = 0; i < space->surface_count; i++) {
        double p[3], d[3];
        for (size_t k = 0; k < 3; k++) {
            p[k] = point[k] / space->surfaces[i].axes[k];
            d[k] = space->towards[k] / space->surfaces[i].axes[k];
        }
        const double ahead = -gm_dot(p, d), beyond = gm_dot(p, p) - 1;
        const bool meets = ahead > 0 && ahead * ahead > gm_dot(d, d) * beyond;
        const bool within = on && on != &space->surfaces[i] && beyond < -1e-9;
        if (meets || within) {
            return true;
        }
    }
    return false;
}
