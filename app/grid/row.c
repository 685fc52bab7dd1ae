/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Named cells as CSV or as JSON. */
#include "app/grid/row.h"

#include <math.h>

#include "app/output/csv.h"
#include "app/output/json.h"

static void begin(struct gm_row *row, const char *key)
{
    fputs(row->begun ? "," : "", row->stream);
    row->begun = true;
    if (row->form == GM_ROW_HEAD) {
        fputs(key, row->stream);
    } else if (row->form == GM_ROW_JSON) {
        gm_json_put_text(row->stream, key);
        fputc(':', row->stream);
    }
}

void gm_row_text(struct gm_row *row, const char *key, const char *text)
{
    begin(row, key);
    if (row->form == GM_ROW_JSON) {
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

void gm_row_list(struct gm_row *row, const char *key, const double *values, size_t count)
{
    begin(row, key);
    for (size_t i = 0; i < count; i++) {
        fputc(i ? ',' : '[', row->stream);
        gm_json_put_number(row->stream, values[i]);
    }
    fputc(']', row->stream);
}
