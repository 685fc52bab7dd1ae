/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_TESTS_COMMON_LAYOUT_FAULTS_H
#define GM_TESTS_COMMON_LAYOUT_FAULTS_H

#include "render/layout/panel.h"

/* What may be asked of every layout, on surfaces of any size. */

/* A font whose letters are all 0.6 em wide; `self` are the metrics. */
double letters_width(const void *self, enum gm_text_size size, const char *text);

/* Metrics of a surface like the painter's of pixels; `self` is to be set to where they stay. */
struct gm_metrics metrics_of(double width, double height);

/* Lays the picture out and says what is wrong, in a text that the next call overwrites: a label that leaves
   the surface, meets another one or stands on data that are not its own; frames that overlap. NULL: nothing
   is. */
const char *layout_fault(struct gm_picture *picture, struct gm_metrics *metrics);

#endif
