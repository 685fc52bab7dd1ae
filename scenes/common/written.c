/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Common parts of scenes made from a user's text. */
#include "scenes/common/written.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/functions/functions.h"
#include "core/schemes.h"

const char *gm_written_number(struct gm_arena *arena, double value, const char *given)
{
    char text[64];
    double number;
    const bool same = given && gm_number_parse(given, &number) && number == value;
    return gm_arena_print(arena, "%s", same ? given : gm_number_format(value, text, sizeof text));
}

struct gm_parameter gm_written_row(struct gm_arena *arena, const struct gm_system_variable *variable,
                                   double value, const char *usual, size_t offset)
{
    const double most = 1e300; /* sliders find a range of their own */
    const bool ranged = !isnan(variable->low);
    return (struct gm_parameter){
        .key = variable->name,
        .unit = variable->unit ? variable->unit : "",
        .help = variable->meaning && variable->meaning[0] ? variable->meaning : usual,
        .type = GM_REAL,
        .offset = offset,
        .standard = gm_written_number(arena, value, variable->text),
        .lowest = variable->fixed ? value
                  : ranged        ? variable->low
                                  : -most,
        .highest = variable->fixed ? value
                   : ranged        ? variable->high
                                   : most,
    };
}

struct gm_parameter gm_written_choice(struct gm_arena *arena, const struct gm_user_system *system, size_t i,
                                      const char *usual, size_t offset)
{
    const struct gm_written_choice *choice = &system->choices.list[i];
    const char **words = gm_arena_take(arena, choice->count + 1, sizeof *words);
    const char *meaning = gm_arena_keep(arena, gm_span_words(system->source, choice->meaning), free);
    for (size_t k = 0; k < choice->count; k++) {
        words[k] = choice->words[k];
    }
    return (struct gm_parameter){.key = choice->name,
                                 .unit = "",
                                 .help = meaning[0] ? meaning : usual,
                                 .type = GM_CHOICE,
                                 .offset = offset,
                                 .standard = choice->words[choice->chosen],
                                 .choices = words};
}

static void set_timing(struct gm_arena *arena, const struct gm_user_system *system, enum gm_system_word word,
                       double value, struct gm_parameter *row)
{
    const struct gm_system_item *item = gm_system_item_of(system, word, 0);
    row->standard = gm_written_number(arena, value, system->texts[word]);
    if (item && !isnan(item->low)) {
        row->lowest = item->low;
        row->highest = item->high;
    }
    row->help = item && item->text[0] ? item->text : row->help;
}

void gm_written_timing(struct gm_arena *arena, const struct gm_user_system *system, double dt, double until,
                       struct gm_parameter *rows)
{
    set_timing(arena, system, GM_WORD_DT, dt, &rows[0]);
    set_timing(arena, system, GM_WORD_UNTIL, until, &rows[1]);
}

uint32_t gm_written_sum(uint32_t sum, const void *bytes, size_t size)
{
    for (const unsigned char *at = bytes, *end = at + size; at < end; at++) {
        sum = (sum ^ *at) * UINT32_C(16777619);
    }
    return sum;
}

const char *gm_written_mark(struct gm_arena *arena, const char *name, const char *text)
{
    const uint32_t sum = gm_written_sum(GM_SUM_OF_NOTHING, text, strlen(text));
    return gm_arena_print(arena, "%s:%08x", name, (unsigned)sum);
}

bool gm_listed_word(const char **list, char *word, size_t size)
{
    const char *text = *list ? *list + strspn(*list, " ,") : "";
    const size_t length = strcspn(text, " ,");
    snprintf(word, size, "%.*s", (int)(length < size ? length : size), text);
    *list = text + length;
    return length > 0;
}

void gm_written_options(struct gm_observable *observable, const struct gm_system_item *item)
{
    observable->title = gm_system_option_text(item, GM_OPTION_TITLE, observable->title);
    observable->unit = gm_system_option_text(item, GM_OPTION_UNIT, observable->unit);
    observable->symbol = gm_system_option_text(item, GM_OPTION_SYMBOL, observable->symbol);
    observable->missing = gm_system_option_text(item, GM_OPTION_MISSING, observable->missing);
    observable->period = gm_system_option(item, GM_OPTION_ANGLE) ? 2 * M_PI : 0;
    observable->logarithmic = observable->logarithmic || gm_system_option(item, GM_OPTION_LOG);
}

void gm_written_work(struct gm_work *work, const struct gm_system_item *item)
{
    const struct gm_system_option *errors = gm_system_option(item, GM_OPTION_ERRORS),
                                  *values = gm_system_option(item, GM_OPTION_VALUES);
    const double halvings = gm_system_option_number(item, GM_OPTION_HALVINGS, work->halvings);
    work->arguments = item->words;
    work->measure = gm_system_option_text(item, GM_OPTION_MEASURE, work->measure);
    work->coarsest = gm_system_option_number(item, GM_OPTION_COARSEST, work->coarsest);
    work->halvings = (int)fmin(fmax(0, halvings), 31);
    work->errors = errors ? errors->numbers : work->errors;
    if (values) {
        work->resolution = item->name;
        work->resolutions = values->numbers;
        work->resolution_count = values->count;
    }
}

void gm_written_figures(struct gm_arena *arena, const struct gm_user_system *system, struct gm_scene *scene)
{
    const struct gm_system_item *item;
    struct gm_figure *figures = NULL;
    size_t count = 0;
    for (; (item = gm_system_item_of(system, GM_WORD_FIGURE, count)); count++) {
        figures = gm_arena_resize(arena, figures, count + 1, sizeof *figures);
        figures[count] =
            (struct gm_figure){.name = item->name, .statement = item->text, .arguments = item->words};
    }
    scene->figures = figures;
    scene->figure_count = count;
}

size_t gm_written_schemes(struct gm_arena *arena, const char *text, const struct gm_problem *problem,
                          const char **schemes)
{
    char name[64];
    size_t count = 0;
    while (count < GM_MOST_PREFERRED && gm_listed_word(&text, name, sizeof name)) {
        const struct gm_scheme *scheme = gm_scheme_find_for(name, problem);
        if (!(scheme && gm_scheme_fits(scheme, problem))) {
            gm_arena_refuse(arena, "schemes: %s %s", name,
                            scheme ? "does not fit this system" : "is not a scheme");
        }
        schemes[count++] = scheme->name;
    }
    return count;
}

double gm_written_rounded(double value)
{
    const double scale = gm_pow(10, floor(gm_log10(value))), digits = value / scale;
    return (digits < sqrt(2) ? 1 : digits < sqrt(10) ? 2 : digits < sqrt(50) ? 5 : 10) * scale;
}
