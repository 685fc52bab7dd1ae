/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The page of figures: one file of HTML with everything in it. */
#include "app/figures/figure.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "app/base/files.h"
#include "core/expression/number.h"
#include "core/memory.h"
#include "render/files/images.h"
#include "render/files/temporary.h"

static void put_text(FILE *page, const char *text)
{
    static const char *const escapes[UCHAR_MAX + 1] = {
        ['&'] = "&amp;", ['<'] = "&lt;", ['>'] = "&gt;", ['"'] = "&quot;"};
    for (; *text; text++) {
        const char *escape = escapes[(unsigned char)*text];
        fputs(escape ? escape : (char[]){*text, '\0'}, page);
    }
}

/* Writes a format that has %s alone, for texts that are escaped. */
__attribute__((format(printf, 2, 3))) static void put(FILE *page, const char *format, ...)
{
    va_list texts;
    va_start(texts, format);
    for (const char *at; (at = strstr(format, "%s")); format = at + 2) {
        fwrite(format, 1, (size_t)(at - format), page);
        put_text(page, va_arg(texts, const char *));
    }
    va_end(texts);
    fputs(format, page);
}

/* Writes a sentence: the first letter is a capital. */
static void put_sentence(FILE *page, const char *text)
{
    putc(toupper((unsigned char)text[0]), page);
    put_text(page, text + 1);
}

/* A page while it is written. */
struct page {
    FILE *file;
    const struct gm_figure_output *output;
    const struct gm_figure_job *jobs;
    const struct gm_outcome *outcomes;
    size_t count;
    bool failed; /* a picture could not be read */
};

static void put_base64(struct page *page, const struct gm_figure_job *job, enum gm_theme theme)
{
    unsigned char bytes[3 * 1024]; /* threes, so that only the end is padded */
    char path[GM_FIGURE_PATH];
    size_t count = 0;
    FILE *file = fopen(gm_figure_path(page->output, job->figure->name, theme, GM_FORMAT_PNG, path), "rb");
    while (file && (count = fread(bytes, 1, sizeof bytes, file)) > 0) {
        gm_base64_put(bytes, count, page->file);
    }
    page->failed = page->failed || !file || ferror(file);
    if (file) {
        fclose(file);
    }
}

static void put_picture(struct page *page, const struct gm_figure_job *job)
{
    fputs("<figure><picture><source media=\"screen and (prefers-color-scheme:dark)\" "
          "srcset=\"data:image/png;base64,",
          page->file);
    put_base64(page, job, GM_THEME_DARK);
    put(page->file, "\"><img loading=\"lazy\" alt=\"%s: %s", job->scene->title, job->figure->statement);
    fprintf(page->file, "\" width=\"%d\" height=\"%d\" src=\"data:image/png;base64,",
            page->output->look.width, page->output->look.height);
    put_base64(page, job, GM_THEME_LIGHT);
    fputs("\"></picture></figure>\n", page->file);
}

/* "open" is not judged either: the document leaves out the deciding values. */
static void put_verdict(FILE *page, const struct gm_figure_job *job, const struct gm_outcome *outcome,
                        size_t index)
{
    const char *style_class = "bad", *mark = "✗";
    if (job->shortened || outcome->verdicts[index].open) {
        style_class = "none", mark = "–";
    } else if (outcome->verdicts[index].holds) {
        style_class = "good", mark = "✓";
    }
    fprintf(page, "<span class=\"%s\">%s %s</span>", style_class, mark, gm_verdict_word(job, outcome, index));
    if (outcome->verdicts[index].note[0] && !job->shortened) {
        fprintf(page, "<br><span class=\"soft\">%s</span>", outcome->verdicts[index].note);
    }
}

static void put_statements(FILE *page, const struct gm_figure_job *job, const struct gm_outcome *outcome)
{
    if (outcome->verdict_count == 0) {
        return;
    }
    fputs("<table class=\"judged\"><thead><tr><th>The document says<th>of<th class=\"n\">expected"
          "<th class=\"n\">found<th></tr></thead><tbody>\n",
          page);
    for (size_t i = 0; i < outcome->verdict_count; i++) {
        char text[128];
        const struct gm_statement *statement = &job->published->statements[i];
        fputs("<tr><td>", page);
        put_sentence(page, statement->says);
        put(page, "<td class=\"soft\">%s%s%s", statement->lanes, statement->against ? " divided by " : "",
            statement->against ? statement->against : "");
        gm_statement_expectation(statement, outcome->verdicts[i].scale, text, sizeof text);
        fprintf(page, "<td data-is=\"expected\">%s", text);
        gm_verdict_number(outcome->verdicts[i].low, outcome->verdicts[i].high, text, sizeof text);
        fprintf(page, "<td class=\"n\" data-is=\"found\">%s<td>", text);
        put_verdict(page, job, outcome, i);
        fputs("</tr>\n", page);
    }
    fputs("</tbody></table>\n", page);
}

static void put_numbers(FILE *page, const struct gm_figure_job *job, const struct gm_outcome *outcome)
{
    fputs("<details><summary>All numbers at the end</summary><div class=\"wide\"><table class=\"all\">"
          "<thead><tr><th>lane<th>t",
          page);
    for (size_t k = 0; k < gm_figure_observables(job); k++) {
        if (gm_outcome_has(outcome, k)) {
            put(page, "<th>%s", job->scene->observables[k].key);
        }
    }
    fputs("</tr></thead><tbody>\n", page);
    for (size_t i = 0; i < outcome->lane_count; i++) {
        put(page, "<tr><td>%s", outcome->lanes[i].label);
        fprintf(page, "<td>%.6g", outcome->lanes[i].t);
        for (size_t k = 0; k < gm_figure_observables(job); k++) {
            const double value = outcome->lanes[i].observables[k];
            if (!gm_outcome_has(outcome, k)) {
                continue;
            }
            fputs("<td>", page);
            if (isfinite(value)) {
                fprintf(page, "%.6g", value);
            } else {
                fputs("–", page);
            }
        }
        fputs("</tr>\n", page);
    }
    fputs("</tbody></table></div></details>\n", page);
}

/* "razafindralandy-34-couette" is "Figure 34, couette". */
static void put_title(FILE *page, const struct gm_figure_job *job)
{
    const char *name = job->figure->name;
    if (gm_figure_is_user(job)) {
        put_text(page, job->figure->statement);
        return;
    }
    const char *number = strchr(name, '-') + 1;
    const int digits = (int)strspn(number, "0123456789");
    fprintf(page, "Figure %.*s", digits, number);
    if (number[digits] == '-') {
        put(page, ", %s", number + digits + 1);
    }
}

static void put_figure(struct page *all, const struct gm_figure_job *job, const struct gm_outcome *outcome)
{
    FILE *page = all->file;
    fprintf(page, "<article id=\"%s\">\n<h3><a href=\"#%s\">", job->figure->name, job->figure->name);
    put_title(page, job);
    put(page, "</a> <span class=\"soft\">%s</span></h3>\n<p>", gm_figure_word(job));
    if (gm_figure_is_user(job)) {
        put_text(page, job->scene->blurb);
    } else {
        put_sentence(page, job->figure->statement);
        fputs(".", page);
    }
    fputs("</p>\n", page);
    if (outcome->progress == GM_MADE) {
        put_picture(all, job);
        put_statements(page, job, outcome);
        if (job->published && job->published->remark) {
            put(page, "<p>%s</p>\n", job->published->remark);
        }
        for (size_t i = 0; i < outcome->lane_count; i++) {
            if (outcome->lanes[i].failure[0]) {
                put(page, "<p class=\"soft\">%s ended early: %s.</p>\n", outcome->lanes[i].label,
                    outcome->lanes[i].failure);
            }
        }
    } else {
        put(page, "<p class=\"notice\">Not made%s%s.</p>\n", outcome->message[0] ? ": " : "",
            outcome->message);
    }
    put(page, "<pre>geomint render %s%s%s</pre>\n", gm_figure_word(job), *job->arguments ? " " : "",
        job->arguments);
    if (outcome->progress == GM_MADE) {
        put_numbers(page, job, outcome);
    }
    fputs("</article>\n", page);
}

static const struct gm_document own_systems = {.prefix = "own", .citation = "Systems of your own"};

static bool is_of(const struct gm_document *document, const struct gm_figure_job *job)
{
    if (document == &own_systems || gm_figure_is_user(job)) {
        return document == &own_systems && gm_figure_is_user(job);
    }
    const size_t length = strlen(document->prefix);
    return strncmp(job->figure->name, document->prefix, length) == 0 && job->figure->name[length] == '-';
}

/* The first view of each figure: the number of its statements that hold. */
static void put_contents(const struct page *all, const struct gm_document *document)
{
    FILE *page = all->file;
    const struct gm_figure_job *jobs = all->jobs;
    fputs("<nav><ol>\n", page);
    for (size_t i = 0; i < all->count; i++) {
        if (!is_of(document, &jobs[i])) {
            continue;
        }
        const struct gm_figure_sum sum = gm_figures_sum(&jobs[i], &all->outcomes[i], 1);
        struct gm_tally tally = {0};
        for (size_t k = 0; k < GM_SOURCES; k++) {
            tally.hold += sum.of[k].hold;
            tally.fail += sum.of[k].fail;
            tally.open += sum.of[k].open;
        }
        fprintf(page, "<li><a href=\"#%s\">", jobs[i].figure->name);
        put_title(page, &jobs[i]);
        const char *scene = jobs[i].scene->name;
        fprintf(page, "</a><span class=\"soft scene\">%s</span>",
                strstr(jobs[i].figure->name, scene) ? "" : scene);
        if (sum.made && gm_figure_is_user(&jobs[i])) {
            fputs("<span>made</span>", page);
        } else if (!sum.made) {
            fputs("<span class=\"bad\">✗ not made</span>", page);
        } else if (tally.hold + tally.fail + tally.open == 0) {
            fputs("<span class=\"none\">– not judged</span>", page);
        } else if (tally.fail > 0) {
            fprintf(page, "<span class=\"bad\">✗ %zu of %zu %s not</span>", tally.fail,
                    tally.hold + tally.fail + tally.open, tally.fail == 1 ? "does" : "do");
        } else if (tally.open > 0) {
            fprintf(page, "<span class=\"none\">– %zu of %zu open</span>", tally.open,
                    tally.hold + tally.open);
        } else {
            fputs("<span class=\"good\">✓ holds</span>", page);
        }
        fputs("</li>\n", page);
    }
    fputs("</ol></nav>\n", page);
}

static void put_sum(FILE *page, const struct gm_figure_sum *sum, size_t count)
{
    const struct gm_tally *said = &sum->of[GM_OF_DOCUMENT], *ours = &sum->of[GM_OF_OURS],
                          *variants = &sum->of[GM_OF_VARIANT];
    fprintf(
        page,
        "<p class=\"sum\">%zu of %zu figure%s made. Of %zu statements of the documents that were measured, "
        "<span class=\"good\">✓ %zu hold</span>, <span class=\"bad\">✗ %zu do not</span> and "
        "<span class=\"none\">– %zu are open</span>.</p>\n",
        sum->made, count, gm_plural((double)count), said->hold + said->fail + said->open, said->hold,
        said->fail, said->open);
    fprintf(
        page,
        "<p class=\"soft\">Counted apart: of %zu statements of ours, marked so, %zu hold; of %zu about a figure "
        "with another value than the document’s, %zu hold.</p>\n",
        ours->hold + ours->fail + ours->open, ours->hold, variants->hold + variants->fail + variants->open,
        variants->hold);
}

static void put_document(struct page *page, const struct gm_document *document)
{
    bool any = false;
    for (size_t i = 0; i < page->count; i++) {
        any |= is_of(document, &page->jobs[i]);
    }
    if (!any) {
        return;
    }
    put(page->file, "<section id=\"%s\">\n<h2>%s</h2>\n", document->prefix, document->citation);
    if (document->link) {
        fprintf(page->file, "<p><a href=\"%s\">%s</a></p>\n", document->link, document->link);
    }
    put_contents(page, document);
    for (size_t i = 0; i < page->count; i++) {
        if (is_of(document, &page->jobs[i])) {
            put_figure(page, &page->jobs[i], &page->outcomes[i]);
        }
    }
    fputs("</section>\n", page->file);
}

static bool put_page(FILE *file, const void *context)
{
    struct page all = *(const struct page *)context, *page = &all;
    page->file = file;
    const struct gm_figure_sum sum = gm_figures_sum(page->jobs, page->outcomes, page->count);
    const bool quick = page->output->quick;
    char slot[GM_PAGE_SLOT];
    for (const char *text = gm_page_text("figures"); gm_page_next(page->file, &text, slot);) {
        if (strcmp(slot, "version") == 0) {
            fputs(GM_VERSION, page->file);
        } else if (strcmp(slot, "sum") == 0) {
            put_sum(page->file, &sum, page->count);
        } else if (strcmp(slot, "notice") == 0 && quick) {
            fputs(
                "<p class=\"notice\">Made with --quick: smaller pictures, and the longest runs are made with "
                "coarser grids or steps. Nothing is judged of those.</p>\n",
                page->file);
        } else if (strcmp(slot, "quick") == 0 && quick) {
            fputs(" --quick", page->file);
        } else if (strcmp(slot, "figures") == 0) {
            size_t count;
            const struct gm_document *documents = gm_documents(&count);
            for (size_t i = 0; i < count; i++) {
                put_document(page, &documents[i]);
            }
            put_document(page, &own_systems);
        }
    }
    return !page->failed;
}

bool gm_figures_page_write(const struct gm_figure_output *output, const struct gm_figure_job *jobs,
                           const struct gm_outcome *outcomes, size_t count, char *message)
{
    char path[GM_FIGURE_PATH];
    const struct page page = {.output = output, .jobs = jobs, .outcomes = outcomes, .count = count};
    snprintf(path, sizeof path, "%s/figures.html", output->folder);
    return gm_temporary_make(path, put_page, &page) ||
           gm_refuse(message, "%.200s/figures.html could not be written: %s", output->folder,
                     gm_memory_was_short() ? "not enough memory" : strerror(errno));
}
