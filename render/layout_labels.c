/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "render/layout_labels.h"

#include <string.h>

bool gm_labels_open(struct gm_label_list *list, struct gm_picture *picture, const struct gm_metrics *metrics,
                    size_t capacity)
{
    *list = (struct gm_label_list){.picture = picture, .metrics = metrics, .capacity = capacity};
    list->labels = gm_picture_memory(picture, capacity * sizeof *list->labels);
    list->boxes = gm_picture_memory(picture, capacity * sizeof *list->boxes);
    return list->labels != NULL && list->boxes != NULL;
}

double gm_labels_width(const struct gm_label_list *list, enum gm_text_size size, const char *text)
{
    return list->metrics->measure(list->metrics->self, size, text);
}

static struct gm_box box_of(const struct gm_label_list *list, const struct gm_label *label)
{
    const double width = gm_labels_width(list, label->size, label->text);
    const double line = list->metrics->line[label->size];
    if (label->vertical) {
        return (struct gm_box){label->x, label->y - 0.5 * width, line, width};
    }
    const double shift = label->anchor == GM_ANCHOR_LEFT     ? 0.0
                         : label->anchor == GM_ANCHOR_CENTRE ? 0.5
                                                             : 1.0;
    return (struct gm_box){label->x - shift * width, label->y, width, line};
}

/* Neighbours in a line need air between them; lines may touch. */
static bool overlap(const struct gm_box *a, const struct gm_box *b, double air)
{
    const double touch = 1e-6;
    return a->x < b->x + b->width + air && b->x < a->x + a->width + air && a->y < b->y + b->height - touch &&
           b->y < a->y + a->height - touch;
}

bool gm_labels_add(struct gm_label_list *list, struct gm_label label)
{
    if (label.text == NULL || label.text[0] == '\0' || list->count == list->capacity) {
        return false;
    }
    const struct gm_metrics *metrics = list->metrics;
    const struct gm_box box = box_of(list, &label);
    const double rounding = 1e-6;
    if (!(box.x >= -rounding && box.y >= -rounding && box.x + box.width <= metrics->width + rounding &&
          box.y + box.height <= metrics->height + rounding)) {
        return false;
    }
    /* what runs along an axis is no neighbour in the line of its ticks */
    const double air = label.vertical ? 0.0 : 4.0 * metrics->scale;
    for (size_t i = 0; i < list->count; i++) {
        if (overlap(&box, &list->boxes[i], air)) {
            return false;
        }
    }
    list->labels[list->count] = label;
    list->boxes[list->count] = box;
    list->count++;
    return true;
}

static bool continues_character(char byte)
{
    return ((unsigned char)byte & 0xc0) == 0x80;
}

/* The first `length` bytes of text, shortened with an ellipsis. */
static const char *ellipsised(struct gm_label_list *list, const char *text, size_t length)
{
    while (length > 0 && (continues_character(text[length]) || text[length - 1] == ' ')) {
        length--;
    }
    return gm_picture_text(list->picture, "%.*s…", (int)length, text);
}

/* The longest front of a text that fits and says something whole: up to a comma, a bracket, or the two blanks
   that stand before a formula. NULL if there is none. */
static const char *whole_front(const struct gm_label_list *list, enum gm_text_size size, const char *text,
                               double width)
{
    static const char *const breaks[] = {"  ", ", ", " (", ": "};
    const char *longest = NULL;
    const double least = 0.5 * width; /* less says too little, but a name before its formula is enough */
    for (size_t i = 0; i < sizeof breaks / sizeof *breaks; i++) {
        for (const char *at = strstr(text, breaks[i]); at != NULL; at = strstr(at + 1, breaks[i])) {
            const char *front = gm_picture_text(list->picture, "%.*s", (int)(at - text), text);
            const double wide = gm_labels_width(list, size, front);
            if (*front != '\0' && wide <= width && (i == 0 || wide >= least) &&
                (longest == NULL || strlen(front) > strlen(longest))) {
                longest = front;
            }
        }
    }
    return longest;
}

const char *gm_labels_shorten(struct gm_label_list *list, enum gm_text_size size, const char *text,
                              double width)
{
    if (text == NULL || gm_labels_width(list, size, text) <= width) {
        return text != NULL ? text : "";
    }
    const char *front = whole_front(list, size, text, width);
    if (front != NULL) {
        return front;
    }
    size_t fits = 0, too_long = strlen(text);
    while (too_long - fits > 1) {
        const size_t middle = fits + (too_long - fits) / 2;
        if (gm_labels_width(list, size, ellipsised(list, text, middle)) <= width) {
            fits = middle;
        } else {
            too_long = middle;
        }
    }
    return fits > 0 ? ellipsised(list, text, fits) : "";
}

size_t gm_labels_wrap(struct gm_label_list *list, enum gm_text_size size, const char *text, double width,
                      size_t most, const char **lines)
{
    size_t count = 0;
    while (text != NULL && *text != '\0' && count < most) {
        if (count + 1 == most || gm_labels_width(list, size, text) <= width) {
            lines[count++] = gm_labels_shorten(list, size, text, width);
            break;
        }
        const char *end = NULL; /* of the longest line that fits */
        for (const char *blank = strchr(text, ' '); blank != NULL; blank = strchr(blank + 1, ' ')) {
            const char *line = gm_picture_text(list->picture, "%.*s", (int)(blank - text), text);
            if (gm_labels_width(list, size, line) > width) {
                break;
            }
            end = blank;
            lines[count] = line;
        }
        if (end == NULL) {
            lines[count++] = gm_labels_shorten(list, size, text, width);
            break;
        }
        count++;
        text = end + 1;
    }
    return count;
}
