/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Statements of documents on their figures, as numbers: share/figures/DOCUMENT.figures. Bounds are the document's own
   if it gives a number. A word means the same throughout, and its bound is a part of a named size: a number "grows" if
   its largest value in the second half of the time is at least a tenth above that in the first, else it is "bounded";
   "round-off" is at most 1e-13, and the "machine precision" 2^-52; "close", "the same" and "very similar" are within 5 %
   of the solution's size, or of the number compared with; "much smaller" is at most a tenth; at most 1 % is not seen;
   "about" is up to twice as much; a time is met within 1 %. */
#include "scenes/common/published.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "core/basics.h"
#include "core/expression/lines.h"
#include "core/files/files.h"

/* The contents of the files, with room for more: reading them takes no memory that could be refused. */
static struct {
    struct gm_document documents[8];
    struct gm_published figures[64];
    struct gm_statement statements[256];
    struct gm_figure_scale scales[64];
    char texts[1 << 16];
    size_t document_count, figure_count, statement_count, scale_count, used;
} store;

static const char *const measures[] = {
    [GM_AT_END] = "end",    [GM_MAXIMUM] = "maximum", [GM_GROWTH] = "growth",
    [GM_FACTOR] = "factor", [GM_LASTS] = "lasts",     [GM_PEAKS] = "peaks",
    [GM_DIPS] = "dips",     [GM_EXCEEDS] = "exceeds", [GM_EXCEEDS + 1] = NULL,
};

/* Keeps the words of a value, with one blank between them. */
static const char *keep_words(const char *text, struct gm_span value)
{
    char *const words = store.texts + store.used, *to = words;
    for (size_t i = value.begin; i < value.end; i++) {
        const char letter = text[i] == '\n' ? ' ' : text[i];
        if (letter != ' ' || text[i - 1] != '\n') { /* a continued line begins with a blank */
            *to++ = letter;
        }
    }
    *to = '\0';
    store.used += (size_t)(to - words) + 1;
    return words;
}

/* Begins a document, a figure, a statement or the scale of one, if the word does. */
static void begin(const char *text, struct gm_span word)
{
    if (gm_span_is(text, word, "document")) {
        store.document_count++;
    } else if (gm_span_is(text, word, "figure")) {
        store.figures[store.figure_count++].statements = store.statements + store.statement_count;
    } else if (gm_span_is(text, word, "says")) {
        store.statements[store.statement_count++] =
            (struct gm_statement){.lanes = "", .low = -INFINITY, .high = INFINITY};
        store.figures[store.figure_count - 1].count++;
    } else if (gm_span_is(text, word, "scale")) {
        store.statements[store.statement_count - 1].scale = &store.scales[store.scale_count++];
    }
}

static void read_line(const char *text, const struct gm_text_line *line)
{
    begin(text, line->word);
    struct gm_document *document = &store.documents[store.document_count - 1];
    struct gm_published *figure = &store.figures[store.figure_count > 0 ? store.figure_count - 1 : 0];
    struct gm_statement *statement =
        &store.statements[store.statement_count > 0 ? store.statement_count - 1 : 0];
    struct gm_figure_scale *scale = &store.scales[store.scale_count > 0 ? store.scale_count - 1 : 0];
    const struct {
        const char *word, **text;
        double *number;
    } rows[] = {
        {"document", &document->prefix, NULL},
        {"citation", &document->citation, NULL},
        {"link", &document->link, NULL},
        {"figure", &figure->figure, NULL},
        {"quick", &figure->quick, NULL},
        {"remark", &figure->remark, NULL},
        {"says", &statement->says, NULL},
        {"lanes", &statement->lanes, NULL},
        {"against", &statement->against, NULL},
        {"observable", &statement->observable, NULL},
        {"over", &statement->over, NULL},
        {"open", &statement->open, NULL},
        {"level", NULL, &statement->level},
        {"from", NULL, &statement->from},
        {"to", NULL, &statement->to},
        {"at_least", NULL, &statement->low},
        {"at_most", NULL, &statement->high},
        {"scale", &scale->name, NULL},
        {"scale_observable", &scale->observable, NULL},
        {"size", NULL, &scale->size},
    };
    const char *value = keep_words(text, line->value);
    for (size_t i = 0; i < GM_COUNT(rows); i++) {
        if (gm_span_is(text, line->word, rows[i].word) && rows[i].text) {
            *rows[i].text = value;
        } else if (gm_span_is(text, line->word, rows[i].word)) {
            *rows[i].number = strtod(value, NULL);
        }
    }
    if (gm_span_is(text, line->word, "measure")) {
        statement->measure = (enum gm_figure_measure)gm_span_among(text, line->value, measures);
    } else if (gm_span_is(text, line->word, "variant_of")) { /* with the same statements */
        figure->variant = true;
        for (size_t i = 0; i < store.figure_count - 1; i++) {
            if (strcmp(store.figures[i].figure, value) == 0) {
                figure->statements = store.figures[i].statements;
                figure->count = store.figures[i].count;
            }
        }
    }
}

static void read_files(void)
{
    for (size_t i = 0; i < gm_built_in_count; i++) {
        const struct gm_built_in *file = &gm_built_in_files[i];
        struct gm_text_line line;
        struct gm_fault fault;
        for (size_t at = 0;
             file->kind == GM_FILE_FIGURES && gm_lines_next(file->text, file->length, &at, &line, &fault);) {
            read_line(file->text, &line);
        }
    }
}

static void need_files(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, read_files);
}

const struct gm_document *gm_documents(size_t *count)
{
    need_files();
    *count = store.document_count;
    return store.documents;
}

const struct gm_published *gm_published_figures(size_t *count)
{
    need_files();
    *count = store.figure_count;
    return store.figures;
}

const struct gm_published *gm_published_find(const char *figure)
{
    size_t count;
    const struct gm_published *figures = gm_published_figures(&count);
    for (size_t i = 0; i < count; i++) {
        if (strcmp(figures[i].figure, figure) == 0) {
            return &figures[i];
        }
    }
    return NULL;
}
