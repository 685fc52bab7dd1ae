/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Labels that do not overlap: a label is taken only if it has room. */
#include "render/layout/panel.h"

#include <stdio.h>
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
    return (struct gm_box){label->x - gm_anchor_share(label->anchor) * width, label->y, width, line};
}

bool gm_labels_add(struct gm_label_list *list, struct gm_label label)
{
    if (!label.text || label.text[0] == '\0' || list->count == list->capacity) {
        return false;
    }
    const struct gm_metrics *metrics = list->metrics;
    const struct gm_box box = box_of(list, &label);
    const double rounding = 1e-6;
    if (!(box.x >= -rounding && box.y >= -rounding && box.x + box.width <= metrics->width + rounding &&
          box.y + box.height <= metrics->height + rounding)) {
        return false;
    }
    /* a text along an axis may touch the line of its ticks */
    const double air = label.vertical ? 0.0 : 4.0 * metrics->scale;
    for (size_t i = 0; i < list->count; i++) {
        if (gm_boxes_overlap(&box, &list->boxes[i], air)) {
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

/* Returns the first `length` bytes of text, shortened with an ellipsis. */
static const char *ellipsised(const struct gm_label_list *list, const char *text, size_t length)
{
    while (length > 0 && (continues_character(text[length]) || text[length - 1] == ' ')) {
        length--;
    }
    return gm_picture_text(list->picture, "%.*s…", (int)length, text);
}

/* Returns true if no bracket is open: half of a formula would have another meaning. */
static bool is_closed(const char *text)
{
    long open = 0;
    for (; *text; text++) {
        open += (*text == '(') - (*text == ')');
    }
    return open <= 0;
}

/* Returns true if a front ends within "a;  b: c": at "a;" or at "a;  b". */
static bool is_between(const char *front, char next)
{
    const size_t length = strlen(front);
    return (length > 0 && front[length - 1] == ';') || (next == ':' && strstr(front, "; "));
}

/* Returns the longest front of a text that fits and is complete: a sentence, a name before its formula, or a
   part before a comma or a bracket that is at least `least` wide. NULL without one. */
static const char *whole_front(const struct gm_label_list *list, enum gm_text_size size, const char *text,
                               double least, double width)
{
    static const struct {
        const char *text;
        size_t kept;    /* bytes of it that remain */
        bool short_too; /* the part before it is enough, however short */
    } breaks[] = {{"  ", 0, true},  {". ", 1, true},  {"; ", 0, true}, {", after ", 0, true},
                  {", ", 0, false}, {" (", 0, false}, {": ", 0, false}};
    const char *longest = NULL;
    for (size_t i = 0; i < sizeof breaks / sizeof *breaks; i++) {
        for (const char *at = strstr(text, breaks[i].text); at; at = strstr(at + 1, breaks[i].text)) {
            size_t length = (size_t)(at - text) + breaks[i].kept;
            length -= length > 0 && text[length - 1] == ','; /* nothing follows it */
            const char *front = gm_picture_text(list->picture, "%.*s", (int)length, text);
            const double wide = gm_labels_width(list, size, front);
            if (*front != '\0' && !is_between(front, *at) && is_closed(front) && wide <= width &&
                (breaks[i].short_too || wide >= least) && (!longest || strlen(front) > strlen(longest))) {
                longest = front;
            }
        }
    }
    return longest;
}

static bool is_digit(char byte)
{
    return byte >= '0' && byte <= '9';
}

/* Moves a cut before a word with a figure: the start of a number is another number. */
static size_t before_cut_number(const char *text, size_t length)
{
    size_t start = length, end = length;
    while (start > 0 && text[start - 1] != ' ') {
        start--;
    }
    while (text[end] != '\0' && text[end] != ' ') {
        end++;
    }
    bool number = false;
    for (size_t i = start; i < end; i++) {
        number = number || is_digit(text[i]);
    }
    return number && length < end ? start : length;
}

/* Returns the most letters of a text that fit with an ellipsis; "" if none do. */
static const char *cut(const struct gm_label_list *list, enum gm_text_size size, const char *text,
                       double width)
{
    size_t fits = 0, too_long = strlen(text);
    while (too_long - fits > 1) {
        const size_t middle = fits + (too_long - fits) / 2;
        if (gm_labels_width(list, size, ellipsised(list, text, middle)) <= width) {
            fits = middle;
        } else {
            too_long = middle;
        }
    }
    fits = before_cut_number(text, fits);
    return fits > 0 ? ellipsised(list, text, fits) : "";
}

const char *gm_labels_shorten(const struct gm_label_list *list, enum gm_text_size size, const char *text,
                              double width)
{
    if (!text || gm_labels_width(list, size, text) <= width) {
        return text ? text : "";
    }
    const char *front = whole_front(list, size, text, 0.5 * width, width);
    return front ? front : cut(list, size, text, width);
}

const char *gm_labels_whole(struct gm_label_list *list, enum gm_text_size size, const char *text,
                            double width)
{
    if (!text || gm_labels_width(list, size, text) <= width) {
        return text ? text : "";
    }
    const char *front = whole_front(list, size, text, 0.0, width);
    return front ? front : "";
}

/* Returns true if the first word of a text is a number. */
static bool is_number(const char *text)
{
    static const char minus[] = "−";
    text += strncmp(text, minus, sizeof minus - 1) == 0 ? sizeof minus - 1 : 0;
    return is_digit(*text) || (*text == '.' && is_digit(text[1]));
}

size_t gm_before_number(const char *text)
{
    size_t at = 0;
    if (!text || strstr(text, " at t = ")) {
        return 0;
    }
    while (text[at] && !is_number(text + at)) {
        at += strcspn(text + at, " ");
        at += text[at] == ' ';
    }
    return text[at] ? at : 0;
}

/* Returns the first of the words before a text's number, and the number. */
static const char *some_words(const struct gm_label_list *list, const char *text, size_t words)
{
    const size_t front = gm_before_number(text), digits = strcspn(text + front, " ");
    size_t length = 0;
    for (; words > 0 && length < front; words--) {
        length += strcspn(text + length, " ") + 1;
    }
    if (length == 0 || length == front) {
        return gm_picture_text(list->picture, "%.*s", (int)(length + digits), text + front - length);
    }
    while (strchr(" ,:", text[length - 1])) {
        length--;
    }
    return gm_picture_text(list->picture, "%.*s… %.*s", (int)length, text, (int)digits, text + front);
}

const char *gm_labels_shorten_number(struct gm_label_list *list, enum gm_text_size size, const char *text,
                                     double width, size_t *words)
{
    const size_t front = gm_before_number(text);
    if (!text || (front == 0 && !is_number(text))) {
        const char *when = text ? strstr(text, " at t = ") : NULL;
        const bool whole = !when || gm_labels_width(list, size, text) <= width;
        const char *what = whole ? text : gm_picture_text(list->picture, "%.*s", (int)(when - text), text);
        return gm_labels_shorten(list, size, what, width);
    }
    size_t all = 0;
    for (size_t at = 0; at < front; at += strcspn(text + at, " ") + 1) {
        all++;
    }
    /* words after the number give way before those ahead of it */
    for (*words = *words > all ? all + 1 : *words;; --*words) {
        const char *shown = *words > all ? text : some_words(list, text, *words);
        if (gm_labels_width(list, size, shown) <= width) {
            return shown;
        }
        if (*words == 0) {
            return "";
        }
    }
}

void gm_name_without_keys(const char *name, char *text, size_t size)
{
    static const char equals[] = " = ", between[] = ", ";
    size_t used = 0;
    text[0] = '\0';
    for (const char *part = name; part && used < size;) {
        const char *next = strstr(part, between), *value = strstr(part, equals);
        const bool key = value != NULL && value == part + strcspn(part, ", "); /* a key is one word */
        value = key ? value + strlen(equals) : part;
        used += (size_t)snprintf(text + used, size - used, "%s%.*s", part == name ? "" : between,
                                 (int)(next ? (size_t)(next - value) : strlen(value)), value);
        part = next ? next + strlen(between) : NULL;
    }
}

size_t gm_labels_wrap(const struct gm_label_list *list, enum gm_text_size size, const char *text,
                      double width, size_t most, const char **lines)
{
    size_t count = 0;
    while (text && *text != '\0' && count < most) {
        if (count + 1 == most || gm_labels_width(list, size, text) <= width) {
            lines[count++] = gm_labels_shorten(list, size, text, width);
            break;
        }
        const char *end = NULL; /* the end of the longest line that fits */
        for (const char *blank = strchr(text, ' '); blank; blank = strchr(blank + 1, ' ')) {
            if (blank[1] == '=' || (blank > text && blank[-1] == '=')) {
                continue; /* a value stays with its key */
            }
            const char *line = gm_picture_text(list->picture, "%.*s", (int)(blank - text), text);
            if (gm_labels_width(list, size, line) > width) {
                break;
            }
            end = blank;
            lines[count] = line;
        }
        if (!end) {
            lines[count++] = gm_labels_shorten(list, size, text, width);
            break;
        }
        count++;
        text = end + 1;
    }
    return count;
}

bool gm_lines_are_whole(const char *const *lines, size_t count, const char *text)
{
    size_t shown = count > 0 ? count - 1 : 0; /* blanks at the ends of lines are left out */
    for (size_t i = 0; i < count; i++) {
        shown += strlen(lines[i]);
    }
    return shown == strlen(text);
}
