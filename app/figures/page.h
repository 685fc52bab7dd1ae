/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_APP_FIGURES_PAGE_H
#define GM_APP_FIGURES_PAGE_H

#include "app/figures/figure.h"

/* Writes FOLDER/figures.html: one file with everything in it, pictures too, that needs neither net nor
   script. Figures that are not made are listed as such. By way of a temporary name. False with a sentence. */
bool gm_figures_page_write(const struct gm_figure_output *output, const struct gm_figure_job *jobs,
                           const struct gm_outcome *outcomes, size_t count, char *message);

#endif
