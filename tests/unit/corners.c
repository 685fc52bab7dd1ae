/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Every scheme of every scene at the corners of the ranges that `list` tells: each parameter at its lowest
   and its highest, or at each of its choices, the others at their defaults. Whatever comes is a sentence, a
   status, or finite numbers, in a bounded time; the sanitizers say whether it was come by honestly.

   corners           every sixth corner, from another one every day; numbers of points, edges, particles are at most 40:
                     what is asked of memory stays small
   corners 40        all of them
   corners 1000      at most 1000 points, edges, particles
   corners 40 pairs  all pairs of corners of two parameters: by hand, for hours
   corners 40 pairs SCENE */
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "app/words/request.h"
#include "core/basics.h"
#include "core/schemes.h"

enum { STEPS = 4, SECONDS = 120, WORD = 96, MOST_WORDS = 16 };

/* One of every kind of problem that scenes make, with meshes that are small where nothing is said of them. */
static const char *const bases[] = {
    "disc points=12",
    "disc points=12 system=pendulum",
    "kepler",
    "kepler perturbation=0.01",
    "vortices",
    "vortices configuration=random count=12 tracers=50",
    "stiff",
    "stiff system=spring-pendulum",
    "henon-heiles",
    "abc",
    "oscillator",
    "sine-gordon points=100",
    "sine-gordon points=101 initial=kink-antikink",
    "kdv points=60",
    "kdv points=61 initial=two-solitons",
    "nls points=60",
    "wave",
    "burgers",
    "soliton points=15",
    "soliton solitons=2 points=15",
    "room rows=10 columns=14 tracers=40",
    "channel columns=40 rows=5",
    "couette rows=8",
    "poiseuille rows=8",
    "cavity columns=8 rows=10",
    "taylor-green columns=8 rows=10",
};

static char line[512]; /* what is being tried */
static long opened, refused, failed;

static void give_up(const char *why)
{
    fprintf(stderr, "%s: %s\n", line, why);
    exit(EXIT_FAILURE);
}

static void too_long(int signal)
{
    (void)signal;
    static const char why[] = ": took too long\n";
    if (write(STDERR_FILENO, line, strlen(line)) < 0 || write(STDERR_FILENO, why, sizeof why - 1) < 0) {
        _exit(EXIT_FAILURE);
    }
    _exit(EXIT_FAILURE);
}

/* The active components: a passive particle that cannot be carried on is lost by itself, as NaN. */
static bool is_finite(const struct gm_lane *lane)
{
    for (size_t i = 0; i < gm_active_count(&lane->problem); i++) {
        if (!isfinite(gm_run_state(lane->run)[i])) {
            return false;
        }
    }
    return true;
}

static void advance(struct gm_lane *lane)
{
    for (int i = 0; i < STEPS; i++) {
        gm_lane_to(lane, lane->run->steps + 1, INFINITY);
        gm_lane_record(lane);
    }
    if (lane->run->status != GM_OK) {
        failed++;
    }
    if (!is_finite(lane)) {
        give_up(lane->run->status == GM_OK ? "status ok, and no finite numbers"
                                           : "a run stays at its last good step, and that is no number");
    }
}

/* The words of `line`, and scheme=NAME for every scheme that fits them. */
static void try_schemes(void)
{
    char text[sizeof line], scheme[WORD], message[GM_MESSAGE] = "";
    char *words[MOST_WORDS + 1], *rest = NULL;
    int count = 0;
    memcpy(text, line, sizeof text);
    for (char *word = strtok_r(text, " ", &rest); word && count < MOST_WORDS;
         word = strtok_r(NULL, " ", &rest)) {
        words[count++] = word;
    }
    const size_t length = strlen(line);
    words[count] = scheme;
    for (size_t i = 0; i < gm_scheme_count(); i++) {
        bool known = false;
        for (size_t j = 0; j < i && !known; j++) {
            known = strcmp(gm_scheme_at(j)->name, gm_scheme_at(i)->name) == 0;
        }
        if (known) {
            continue;
        }
        snprintf(scheme, sizeof scheme, "scheme=%s", gm_scheme_at(i)->name);
        snprintf(line + length, sizeof line - length, " %s", scheme);
        alarm(SECONDS);
        struct gm_request request;
        message[0] = '\0';
        struct gm_lane *lane = NULL;
        if (gm_request_parse(&request, count + 1, words, 1, message)) {
            lane = gm_request_open_lane(&request, 0, message);
            gm_request_close(&request);
        }
        if (lane) {
            opened++;
            if (!is_finite(lane)) {
                give_up("a start that is no number");
            }
            advance(lane);
        } else if (!message[0]) {
            give_up("refused without a sentence");
        } else {
            refused++;
        }
        gm_lane_close(lane);
        alarm(0);
    }
    line[length] = '\0';
}

struct corner {
    const char *key;
    char word[WORD];
};

/* What a parameter may be at its ends; 0 for texts and for the end of time, which no step asks for. */
static size_t corners_of(const struct gm_parameter *row, double most, struct corner *corners)
{
    size_t count = 0;
    if (row->type == GM_CHOICE) {
        for (; row->choices[count]; count++) {
            snprintf(corners[count].word, WORD, "%s=%s", row->key, row->choices[count]);
        }
    } else if (row->type == GM_BOOLEAN) {
        snprintf(corners[count++].word, WORD, "%s=no", row->key);
        snprintf(corners[count++].word, WORD, "%s=yes", row->key);
    } else if (row->type != GM_TEXT && strcmp(row->key, "until") != 0) {
        double low = row->lowest, high = row->highest;
        if (row->type == GM_INTEGER) {
            high = fmax(fmin(high, most), low);
        } else if (strcmp(row->key, "dx") == 0) {
            low = fmax(low, 1 / (25 * most)); /* Burgers' grid is told by the distance of its points */
        }
        snprintf(corners[count++].word, WORD, "%s=%.17g", row->key, low);
        snprintf(corners[count++].word, WORD, "%s=%.17g", row->key, high);
    }
    for (size_t i = 0; i < count; i++) {
        corners[i].key = row->key;
    }
    return count;
}

/* A word of the base gives way to a corner of the same key. */
static void put_line(const char *base, const struct corner *const *corners, size_t count)
{
    char text[sizeof line], *rest = NULL;
    snprintf(text, sizeof text, "%s", base);
    line[0] = '\0';
    for (char *word = strtok_r(text, " ", &rest); word; word = strtok_r(NULL, " ", &rest)) {
        bool replaced = false;
        for (size_t i = 0; i < count; i++) {
            const size_t length = strlen(corners[i]->key);
            replaced |= strncmp(word, corners[i]->key, length) == 0 && word[length] == '=';
        }
        if (!replaced) {
            snprintf(line + strlen(line), sizeof line - strlen(line), "%s%s", line[0] ? " " : "", word);
        }
    }
    for (size_t i = 0; i < count; i++) {
        snprintf(line + strlen(line), sizeof line - strlen(line), " %s", corners[i]->word);
    }
}

int main(int count, char **arguments)
{
    enum { MOST_CORNERS = 256 };
    const bool all = count > 1;
    const double most = all ? strtod(arguments[1], NULL) : 40;
    const size_t day = (size_t)time(NULL) / 86400;
    const bool pairs = count > 2 && strcmp(arguments[2], "pairs") == 0;
    const char *only = count > 3 ? arguments[3] : NULL;
    signal(SIGALRM, too_long);
    for (size_t b = 0; b < GM_COUNT(bases); b++) {
        char name[WORD];
        snprintf(name, sizeof name, "%.*s", (int)strcspn(bases[b], " "), bases[b]);
        const struct gm_scene *scene = gm_scene_find(name);
        struct corner corners[MOST_CORNERS];
        size_t made = 0;
        if (!scene) {
            snprintf(line, sizeof line, "%s", bases[b]);
            give_up("there is no such scene");
        }
        if (only && strcmp(name, only) != 0) {
            continue;
        }
        for (size_t i = 0; i < scene->parameter_count; i++) {
            made += corners_of(&scene->parameters[i], most, corners + made);
        }
        for (size_t i = 0; i < gm_settings_parameter_count; i++) {
            made += corners_of(&gm_settings_parameters[i], most, corners + made);
        }
        const long before = opened;
        for (size_t i = all ? 0 : day % 6; i < made; i += all ? 1 : 6) {
            const struct corner *both[2] = {&corners[i]};
            put_line(bases[b], both, 1);
            try_schemes();
            for (size_t j = i + 1; pairs && j < made; j++) {
                if (strcmp(corners[i].key, corners[j].key) != 0) {
                    both[1] = &corners[j];
                    put_line(bases[b], both, 2);
                    try_schemes();
                }
            }
        }
        if (opened == before) {
            give_up("nothing could be opened at any corner");
        }
    }
    printf("day %zu: %ld lanes opened, of which %ld ended with a status; %ld refused with a sentence\n", day,
           opened, failed, refused);
    return EXIT_SUCCESS;
}
