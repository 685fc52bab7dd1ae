/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Command lines that reproduce a session. */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/runs/session.h"

/* Writes the arguments as a shell reads them; for a view without until= and steps=. */
static void put_arguments(FILE *stream, const char *text, bool view)
{
    struct gm_arguments arguments = {0};
    gm_arguments_split(&arguments, text);
    for (int i = 0; i < arguments.count; i++) {
        const char *word = arguments.words[i];
        if (!view || (strncmp(word, "until=", 6) != 0 && strncmp(word, "steps=", 6) != 0)) {
            fputc(' ', stream);
            gm_arguments_put_shell(stream, word);
        }
    }
    gm_arguments_close(&arguments);
}

static void put_changes(FILE *stream, const struct gm_request *log)
{
    char *list = log->change_count > 0 ? gm_changes_format(log, ':', ',') : NULL;
    if (list) {
        list[strlen(list) - 1] = '\0';
        fputs(" --changes ", stream);
        gm_arguments_put_shell(stream, list);
    }
    free(list);
}

/* Returns the command for a request: `geomint render` for a view, else `geomint`. The caller frees it;
   NULL when out of memory. */
static char *command_of(const struct gm_request *request, const struct gm_session *view, enum gm_theme theme)
{
    struct gm_text_stream writing = {0};
    char *arguments = gm_request_format(request);
    FILE *stream = arguments ? gm_stream_begin(&writing) : NULL;
    if (stream) {
        fputs(view ? "geomint render" : "geomint", stream);
        put_arguments(stream, arguments, view);
        if (view) {
            const int64_t steps = view->lanes[0]->run->steps;
            size_t same = 1; /* steps= if all lanes have made the same number of steps, else until= */
            while (same < view->count && view->lanes[same]->run->steps == steps) {
                same++;
            }
            if (same == view->count) {
                fprintf(stream, " steps=%" PRId64, steps);
            } else {
                fprintf(stream, " until=%.17g", gm_session_time(view));
            }
            put_changes(stream, request);
            fprintf(stream, " --theme %s", theme == GM_THEME_DARK ? "dark" : "light");
        }
    }
    free(arguments);
    return gm_stream_end(&writing);
}

char *gm_session_picture_command(const struct gm_session *session, enum gm_theme theme)
{
    return command_of(&session->log, session, theme);
}

char *gm_session_explorer_command(const struct gm_session *session)
{
    struct gm_lane_spec lanes[GM_MOST_LANES];
    struct gm_request present = session->log;
    size_t copied = 0;
    present.lanes = lanes;
    present.arguments = session->log.change_count > 0 ? NULL : session->log.arguments;
    for (size_t i = 0; i < session->count; i++) {
        const struct gm_settings *settings = gm_session_owner(session, i, true);
        lanes[i] = (struct gm_lane_spec){
            .shown = session->lanes[i]->shown, .settings = *settings, .scheme = session->lanes[i]->scheme};
        lanes[i].parameters = gm_parameters_copy(session->scene, gm_session_owner(session, i, false));
        struct gm_timing *timing = lanes[i].parameters;
        if (timing) {
            copied++;
            timing->dt = fabs(timing->dt); /* a run starts forwards in time */
        }
    }
    char *text = copied == session->count ? command_of(&present, NULL, GM_THEME_DARK) : NULL;
    for (size_t i = 0; i < session->count; i++) {
        free(lanes[i].parameters);
    }
    return text;
}
