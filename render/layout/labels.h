/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_RENDER_LAYOUT_LABELS_H
#define GM_RENDER_LAYOUT_LABELS_H

#include "render/layout/surface.h"

/* The labels of a layout under construction: a label is taken only if it is wholly on the surface and on no
   label taken before, so the order in which they are offered is their rank. */

struct gm_label_list {
    struct gm_picture *picture;
    const struct gm_metrics *metrics;
    struct gm_label *labels;
    struct gm_box *boxes; /* what each covers */
    size_t count, capacity;
};

/* False when memory is short. */
bool gm_labels_open(struct gm_label_list *list, struct gm_picture *picture, const struct gm_metrics *metrics,
                    size_t capacity);

/* True if the label was taken. Empty texts never are. */
bool gm_labels_add(struct gm_label_list *list, struct gm_label label);

double gm_labels_width(const struct gm_label_list *list, enum gm_text_size size, const char *text);

/* The text, shortened to width with an ellipsis where needed; "" if not even that fits. A word with a
   figure in it is not cut. */
const char *gm_labels_shorten(const struct gm_label_list *list, enum gm_text_size size, const char *text,
                              double width);

/* The same for a text that tells a number, such as "energy error now 2.4·10⁻³": of what stands before the
   number the last words give way, so that it begins as it did; the number is whole, or the text is "". At most
   `*words` of them are shown, which is set to how many are, so that texts of a kind can be shortened alike.
   Where something happened "at t = 3" what happened comes first. */
const char *gm_labels_shorten_number(struct gm_label_list *list, enum gm_text_size size, const char *text,
                                     double width, size_t *words);
/* The bytes before the number that a text tells; 0: none, or it tells when something happened. */
size_t gm_before_number(const char *text);

/* The text, or a front of it that says something whole; "" if neither fits. */
const char *gm_labels_whole(struct gm_label_list *list, enum gm_text_size size, const char *text,
                            double width);

/* Writes the name of a lane without the keys of its values, which are one word: of "Verlet, Δt = 0.1"
   "Verlet, 0.1". */
void gm_name_without_keys(const char *name, char *text, size_t size);

/* Breaks a text at blanks into at most `most` lines of a width, the last shortened; returns their number. */
size_t gm_labels_wrap(const struct gm_label_list *list, enum gm_text_size size, const char *text,
                      double width, size_t most, const char **lines);

/* Whether lines of gm_labels_wrap hold all of the text. */
bool gm_lines_are_whole(const char *const *lines, size_t count, const char *text);

#endif
