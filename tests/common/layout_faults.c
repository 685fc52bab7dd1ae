/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The faults of a layout, as boxes that meet or leave the surface. */
#include "tests/common/layout_faults.h"

#include <math.h>
#include <stdio.h>

double letters_width(const void *self, enum gm_text_size size, const char *text)
{
    const struct gm_metrics *metrics = self;
    size_t letters = 0;
    for (; *text != '\0'; text++) {
        letters += ((unsigned char)*text & 0xc0) != 0x80;
    }
    return 0.6 / 1.17 * metrics->line[size] * (double)letters;
}

struct gm_metrics metrics_of(double width, double height)
{
    static const double shares[GM_TEXT_SIZE_COUNT] = {0.036, 0.025, 0.022, 0.021};
    struct gm_metrics metrics = {.width = width, .height = height, .measure = letters_width};
    metrics.scale = fmin(height / 720.0, width / 960.0);
    metrics.terse = height < 540.0;
    for (int i = 0; i < GM_TEXT_SIZE_COUNT; i++) {
        metrics.line[i] = 1.17 * fmax(9.0, 720.0 * metrics.scale * shares[i]);
    }
    return metrics;
}

static struct gm_box label_box(const struct gm_metrics *metrics, const struct gm_label *label)
{
    const double width = letters_width(metrics, label->size, label->text), line = metrics->line[label->size];
    if (label->vertical) {
        return (struct gm_box){label->x, label->y - 0.5 * width, line, width};
    }
    const double share = label->anchor == GM_ANCHOR_LEFT     ? 0.0
                         : label->anchor == GM_ANCHOR_CENTRE ? 0.5
                                                             : 1.0;
    return (struct gm_box){label->x - share * width, label->y, width, line};
}

static bool apart(struct gm_box a, struct gm_box b)
{
    const double touch = 1e-3;
    return a.x + a.width <= b.x + touch || b.x + b.width <= a.x + touch || a.y + a.height <= b.y + touch ||
           b.y + b.height <= a.y + touch;
}

static bool within(const struct gm_metrics *metrics, struct gm_box box)
{
    const double touch = 1e-3;
    return box.x >= -touch && box.y >= -touch && box.x + box.width <= metrics->width + touch &&
           box.y + box.height <= metrics->height + touch && box.width >= 0.0 && box.height >= 0.0;
}

/* A text among the marks belongs to the one frame that it may stand on. */
static bool on_others_data(const struct gm_layout *layout, const struct gm_label *label, struct gm_box box)
{
    size_t stands = 0;
    for (size_t i = 0; i < layout->frame_count; i++) {
        stands += !apart(layout->frames[i].box, box);
    }
    return stands > (label->among_marks ? 1 : 0);
}

const char *layout_fault(struct gm_picture *picture, struct gm_metrics *metrics)
{
    static char fault[256];
    metrics->self = metrics;
    const struct gm_layout *layout = gm_layout_make(picture, metrics);
    if (!layout) {
        return "there is no layout";
    }
    for (size_t i = 0; i < layout->label_count; i++) {
        const struct gm_label *label = &layout->labels[i];
        const struct gm_box box = label_box(metrics, label);
        if (!within(metrics, box)) {
            snprintf(fault, sizeof fault, "\"%s\" leaves the surface", label->text);
            return fault;
        }
        for (size_t k = 0; k < i; k++) {
            if (!apart(box, label_box(metrics, &layout->labels[k]))) {
                snprintf(fault, sizeof fault, "\"%s\" meets \"%s\"", label->text, layout->labels[k].text);
                return fault;
            }
        }
        if (on_others_data(layout, label, box)) {
            snprintf(fault, sizeof fault, "\"%s\" stands on data", label->text);
            return fault;
        }
    }
    for (size_t i = 0; i < layout->frame_count; i++) {
        bool good = within(metrics, layout->frames[i].box);
        for (size_t k = 0; k < i; k++) {
            good = good && apart(layout->frames[i].box, layout->frames[k].box);
        }
        if (!good) {
            snprintf(fault, sizeof fault, "the frame of \"%s\" overlaps or leaves the surface",
                     layout->frames[i].panel->title);
            return fault;
        }
    }
    return NULL;
}
