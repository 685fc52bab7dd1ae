/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The files of a measuring command: its diagram and its table. */
#include "app/output/printer.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/base/arguments.h"
#include "app/output/folder.h"
#include "app/output/row.h"
#include "app/words/request.h"
#include "render/files/temporary.h"
#include "render/message.h"

/* The text of the system that a command "stability NAME key=value" is of; NULL: it is of none. */
static const char *source_of(const char *command)
{
    char message[GM_MESSAGE];
    int refusal;
    struct gm_arguments words = {0};
    const struct gm_scene *scene = NULL;
    if (gm_arguments_split(&words, command) && words.count > 1) {
        const int place = gm_provenance_scene_place(&words);
        scene = gm_request_scene(place > 1 ? 1 : words.count - 1, words.words + place, &refusal, message);
    }
    gm_arguments_close(&words);
    return scene ? scene->source : NULL;
}

static bool describe(struct gm_provenance *provenance, const void *data, const struct gm_appearance *look,
                     const char *painter)
{
    const char *command = ((const struct gm_chart *)data)->command;
    return gm_provenance_of_command(provenance, command, source_of(command), look, painter);
}

static void draw(const void *data, struct gm_picture *picture)
{
    const struct gm_chart *chart = data;
    chart->draw(chart->data, picture);
}

static bool paint(struct gm_chart *chart, char *message)
{
    return gm_print_write(&chart->print, &(struct gm_printed){chart, describe, draw}, message);
}

/* Sets the paths of both files. Returns false if a name is too long. */
static bool name_files(struct gm_chart *chart)
{
    const char *folder = chart->folder ? chart->folder : ".";
    const char *path = chart->path ? chart->path : "";
    const bool stream = strcmp(path, "-") == 0;
    const size_t stem = strlen(path) > strlen(".png") ? strlen(path) - strlen(".png") : 0;
    const int picture = chart->path ? snprintf(chart->picture, sizeof chart->picture, "%s", path)
                                    : snprintf(chart->picture, sizeof chart->picture, "%s/%s.%s", folder,
                                               chart->name, gm_format_name(chart->print.format));
    const int csv = stream        ? snprintf(chart->csv, sizeof chart->csv, "%s", "")
                    : chart->path ? snprintf(chart->csv, sizeof chart->csv, "%.*s.csv", (int)stem, path)
                                  : snprintf(chart->csv, sizeof chart->csv, "%s/%s.csv", folder, chart->name);
    chart->print.path = chart->picture;
    return picture < (int)sizeof chart->picture && csv < (int)sizeof chart->csv;
}

/* Returns true if two files begin with the same line, a table's head. */
static bool have_one_head(const char *one, const char *other)
{
    struct gm_csv_lines tables[] = {{.stream = fopen(one, "r")}, {.stream = fopen(other, "r")}};
    const char *head = gm_csv_next(&tables[0]), *second = gm_csv_next(&tables[1]);
    const bool same = head && second && strcmp(head, second) == 0;
    gm_csv_close(&tables[0]);
    gm_csv_close(&tables[1]);
    return same;
}

static bool fail(const struct gm_chart *chart, char *message)
{
    return gm_refuse(message, "%.400s could not be written: %s", chart->csv, strerror(errno));
}

/* Returns false with errno. */
static bool write_table(const struct gm_chart *chart, const char *path)
{
    FILE *table = fopen(path, "w");
    if (!table) {
        return false;
    }
    const bool written = chart->write(chart->data, table) && !ferror(table);
    return fclose(table) == 0 && written;
}

/* The numbers aside first. A table that was there before the picture and has other columns stays, and nothing is
   drawn: the table's name follows from the picture's and was not given by the user. */
static bool write_from(struct gm_chart *chart, const char *aside, char *message)
{
    if (access(chart->csv, F_OK) == 0 && access(chart->picture, F_OK) != 0 &&
        !have_one_head(aside, chart->csv)) {
        return gm_refuse(message,
                         "%.300s is there, with other columns than the numbers of this picture; name the "
                         "picture otherwise",
                         chart->csv);
    }
    return paint(chart, message) &&
           (strcmp(aside, chart->csv) == 0 || rename(aside, chart->csv) == 0 || fail(chart, message));
}

static bool write_both(struct gm_chart *chart, char *message)
{
    char *aside = gm_temporary_fits(chart->csv) ? gm_temporary_name(chart->csv, ".tmp") : strdup(chart->csv);
    if (!aside) {
        return gm_refuse(message, "not enough memory for a table");
    }
    const bool written =
        (write_table(chart, aside) || fail(chart, message)) && write_from(chart, aside, message);
    if (!written && strcmp(aside, chart->csv) != 0) {
        unlink(aside);
    }
    free(aside);
    return written;
}

bool gm_chart_write(struct gm_chart *chart, char *message)
{
    if (!name_files(chart)) {
        return gm_refuse(message, "the name of the folder is too long");
    }
    return gm_folder_make_for(chart->picture, message) &&
           (chart->write && chart->csv[0] ? write_both : paint)(chart, message);
}
