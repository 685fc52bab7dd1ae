/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_TOURS_MOVIE_H
#define GM_APP_TOURS_MOVIE_H

#include "app/tours/tour.h"
#include "render/layout/appearance.h"

/* What is made of a tour without a screen, with its texts: a movie, or pictures, one for every question and
   one for the end of every step. */
struct gm_tour_output {
    const char *movie;  /* the file; NULL: pictures */
    const char *folder; /* of the pictures, made if it is missing; NULL: the present one */
    double fps;         /* of the movie */
    struct gm_appearance look;
};

/* Returns the exit status. */
int gm_tour_render(const struct gm_tour *tour, const struct gm_tour_output *output);

#endif
