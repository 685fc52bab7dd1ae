/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_SCENES_COMMON_CAMERA_H
#define GM_SCENES_COMMON_CAMERA_H

#include "render/picture/picture.h"
#include "scenes/common/rows.h"

/* A view of space from far away, by parallel light: the place of a point on the screen, its depth, and the
   surfaces that hide it. */

/* The direction of view. The eye is in the direction (cos e cos a, cos e sin a, sin e) from the centre, with
   azimuth a and elevation e in degrees; z points up. */
struct gm_camera {
    double azimuth, elevation;
    double zoom; /* size, 1: the box just fits */
    double turn; /* growth of the azimuth, in degrees per unit of time */
};

/* The rows of a scene's table for `member`, a camera in its struct `own`. */
enum { GM_CAMERA_KEYS = 4 };
#define GM_CAMERA_ROWS(own, member)                                                                          \
    GM_REAL_ROW(own, member.azimuth, "azimuth", "-60", -180, 180,                                            \
                "direction of view, in degrees from x to y", .live = true, .looks = true),                   \
        GM_REAL_ROW(own, member.elevation, "elevation", "25", -90, 90,                                       \
                    "height of the eye above the plane, in degrees", .live = true, .looks = true),           \
        GM_REAL_ROW(own, member.zoom, "zoom", "1", 0.1, 100, "magnification; 1: the whole picture fits",     \
                    .logarithmic = true, .live = true, .looks = true),                                       \
        GM_REAL_ROW(own, member.turn, "turn", "0", -1e6, 1e6,                                                \
                    "by which the azimuth grows, in degrees for each unit of time", .live = true,            \
                    .looks = true)
/* True if a parameter of the camera has that key. */
bool gm_camera_has(const char *key);

/* An ellipsoid around the origin, with half axes along x, y, z. */
struct gm_ellipsoid {
    double axes[3];
};

struct gm_space {
    double right[3], up[3], towards[3]; /* unit vectors of the screen, and to the eye */
    double low[3], high[3];             /* the box of all that is shown */
    double back, front;                 /* range of depths of that box, for every azimuth */
    const struct gm_ellipsoid *surfaces;
    size_t surface_count;
};

/* Sets the directions, at a time after the start. */
void gm_space_turn(struct gm_space *space, const struct gm_camera *camera, double t);
/* Sets depths and the panel's axes for the box, or with `reach` > 0 for that distance around the origin: a
   scale that does not change while the camera turns. */
void gm_space_fit(struct gm_space *space, const struct gm_camera *camera, double reach,
                  struct gm_panel *panel);

/* Computes the place of a point on the screen. Returns its depth: the nearer to the eye, the greater. */
double gm_space_place(const struct gm_space *space, const double point[3], double place[2]);
/* Returns the nearness of a depth, from 0 at the back of the box to 1 in front. */
double gm_space_nearness(const struct gm_space *space, double depth);
/* Returns true if a surface hides a point. Surfaces are of glass: a point within one is hidden behind its
   farther half only. For lines on the surface `on` the others are solid. */
bool gm_space_hides(const struct gm_space *space, const double point[3], const struct gm_ellipsoid *on);

#endif
