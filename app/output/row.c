/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Named cells as CSV or as JSON. */
#include "app/output/row.h"

#include <math.h>

#include "app/output/csv.h"
#include "app/output/json.h"

static void begin(struct gm_row *row, const char *key)
{
    fputs(row->begun ? "," : "", row->stream);
    row->begun = true;
    if (row->form == GM_ROW_HEAD) {
        fputs(key, row->stream);
    } else if (row->form == GM_ROW_JSON && key) {
        gm_json_put_text(row->stream, key);
        fputc(':', row->stream);
    }
}

void gm_row_text(struct gm_row *row, const char *key, const char *text)
{
    begin(row, key);
    if (!text) {
        fputs("null", row->stream);
    } else if (row->form == GM_ROW_JSON) {
        gm_json_put_text(row->stream, text);
    } else if (row->form == GM_ROW_CSV) {
        gm_csv_put_text(row->stream, text);
    }
}

void gm_row_number(struct gm_row *row, const char *key, double value, int digits)
{
    begin(row, key);
    if (row->form == GM_ROW_JSON) {
        gm_json_put_number(row->stream, value);
    } else if (row->form == GM_ROW_CSV && !isnan(value)) {
        fprintf(row->stream, "%.*g", digits, value);
    }
}

void gm_row_count(struct gm_row *row, const char *key, double value)
{
    begin(row, key);
    if (row->form != GM_ROW_HEAD) {
        fprintf(row->stream, "%.0f", value);
    }
}

void gm_row_flag(struct gm_row *row, const char *key, bool value)
{
    begin(row, key);
    fputs(value ? "true" : "false", row->stream);
}

void gm_row_list(struct gm_row *row, const char *key, const double *values, size_t count)
{
    begin(row, key);
    for (size_t i = 0; i < count; i++) {
        fputc(i ? ',' : '[', row->stream);
        gm_json_put_number(row->stream, values[i]);
    }
    fputc(']', row->stream);
}

struct gm_row gm_row_begin(FILE *stream)
{
    fputc('{', stream);
    return (struct gm_row){.stream = stream, .form = GM_ROW_JSON, .end = '}'};
}

struct gm_row gm_row_open(struct gm_row *row, const char *key, char end)
{
    begin(row, key);
    fputc(end == '}' ? '{' : '[', row->stream);
    return (struct gm_row){.stream = row->stream, .form = GM_ROW_JSON, .end = end};
}

void gm_row_close(const struct gm_row *row)
{
    fputc(row->end, row->stream);
}
