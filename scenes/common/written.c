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

const char *gm_kept_texts_add(struct gm_kept_texts *texts, char *text)
{
    char **more = text ? realloc(texts->list, (texts->count + 1) * sizeof *more) : NULL;
    if (!more) {
        free(text);
        return NULL;
    }
    texts->list = more;
    return more[texts->count++] = text;
}

const char *gm_kept_number(struct gm_kept_texts *texts, double value, const char *given)
{
    char text[64];
    double number;
    const bool same = given && gm_number_parse(given, &number) && number == value;
    return gm_kept_texts_add(texts, strdup(same ? given : gm_number_format(value, text, sizeof text)));
}

struct gm_parameter gm_written_row(struct gm_kept_texts *texts, const struct gm_system_variable *variable,
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
        .standard = gm_kept_number(texts, value, variable->text),
        .lowest = variable->fixed ? value
                  : ranged        ? variable->low
                                  : -most,
        .highest = variable->fixed ? value
                   : ranged        ? variable->high
                                   : most,
    };
}

static bool set_timing(struct gm_kept_texts *texts, const struct gm_user_system *system,
                       enum gm_system_word word, double value, struct gm_parameter *row)
{
    const struct gm_system_item *item = gm_system_item_of(system, word, 0);
    row->standard = gm_kept_number(texts, value, system->texts[word]);
    if (item && !isnan(item->low)) {
        row->lowest = item->low;
        row->highest = item->high;
    }
    row->help = item && item->text[0] ? item->text : row->help;
    return row->standard != NULL;
}

bool gm_written_timing(struct gm_kept_texts *texts, const struct gm_user_system *system, double dt,
                       double until, struct gm_parameter *dt_row, struct gm_parameter *until_row)
{
    return set_timing(texts, system, GM_WORD_DT, dt, dt_row) &&
           set_timing(texts, system, GM_WORD_UNTIL, until, until_row);
}

void gm_kept_texts_close(struct gm_kept_texts *texts)
{
    for (size_t i = 0; i < texts->count; i++) {
        free(texts->list[i]);
    }
    free(texts->list);
}

/* FNV-1a */
char *gm_written_mark(const char *name, const char *text)
{
    uint32_t sum = UINT32_C(2166136261);
    char *mark = NULL;
    for (const char *at = text; *at; at++) {
        sum = (sum ^ (unsigned char)*at) * UINT32_C(16777619);
    }
    return asprintf(&mark, "%s:%08x", name, (unsigned)sum) < 0 ? NULL : mark;
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

bool gm_written_schemes(const char *text, const struct gm_problem *problem, const char **schemes, size_t most,
                        size_t *count, char *sentence)
{
    char name[64];
    for (*count = 0; *count < most && gm_listed_word(&text, name, sizeof name);) {
        const struct gm_scheme *scheme = gm_scheme_find_for(name, problem);
        if (!(scheme && gm_scheme_fits(scheme, problem))) {
            return gm_refuse(sentence, "schemes: %s %s", name,
                             scheme ? "does not fit this system" : "is not a scheme");
        }
        schemes[(*count)++] = scheme->name;
    }
    return true;
}

double gm_written_rounded(double value)
{
    const double scale = gm_pow(10, floor(gm_log10(value))), digits = value / scale;
    return (digits < sqrt(2) ? 1 : digits < sqrt(10) ? 2 : digits < sqrt(50) ? 5 : 10) * scale;
}
