/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_TOURS_MOVIE_H
#define GM_APP_TOURS_MOVIE_H

#include "app/commands/options.h"
#include "app/tours/tour.h"

/* Renders a tour with its texts, without a screen: as options->movie, or below options->out as pictures, one
   for every question and one for the end of every step. Returns the exit status. */
int gm_tour_render(const struct gm_tour *tour, const struct gm_options *options);

#endif
