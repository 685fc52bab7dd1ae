/* SPDX-License-Identifier: GPL-3.0-or-later */
/* From words to a scene and its lanes, with a sentence for a fault. */
#include "app/words/request.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/native/engine.h"
#include "app/words/names.h"
#include "app/words/system.h"
#include "app/words/typed_file.h"
#include "app/words/words.h"
#include "core/arena.h"
#include "core/memory.h"
#include "core/ode/families/splitting/parts.h"
#include "core/ode/ode.h"
#include "core/schemes.h"
#include "scenes/common/symbol.h"

bool gm_value_read(const struct gm_parameter *row, void *owner, const char *text, char *message)
{
    _Alignas(max_align_t) char place[GM_TEXT_SIZE];
    struct gm_parameter alone = *row;
    alone.offset = 0;
    switch (gm_parameter_set(owner ? row : &alone, owner ? owner : place, text)) {
    case GM_PARSED:
        return !row->admits || row->admits(row, text, message);
    case GM_NOT_UNDERSTOOD:
        if (row->type == GM_CHOICE || row->type == GM_BOOLEAN) {
            char choices[GM_MESSAGE / 2] = "no, yes";
            if (row->type == GM_CHOICE) {
                gm_parameter_choices(row, choices, sizeof choices);
            }
            return gm_refuse(message, "%s=%.60s is none of: %s", row->key, text, choices);
        }
        return gm_refuse(message, "%s=%.60s is not %s", row->key, text,
                         row->type == GM_TEXT      ? "a word of at most 255 bytes without blanks"
                         : row->type == GM_INTEGER ? "a whole number"
                                                   : "a number");
    case GM_OUT_OF_RANGE:
        break;
    }
    char low[40], high[40], nearest[96] = "";
    double value = NAN;
    gm_number_parse(text, &value);
    gm_number_format(fmax(row->lowest, row->least), low, sizeof low);
    gm_number_format(row->highest, high, sizeof high);
    if (strcmp(row->key, "dt") == 0 && value < 0) {
        snprintf(nearest, sizeof nearest, "; key B of the explorer turns time");
    } else if (!isnan(value) && !(row->least > 0)) {
        snprintf(nearest, sizeof nearest, "; the nearest is %s", value < row->lowest ? low : high);
    }
    return gm_refuse(message, "%s=%.60s is out of range: it %slies between %s and %s%s", row->key, text,
                     row->least > 0 ? "is 0 or " : "", low, high, nearest);
}

/* ---- lanes, in a body of the words' arena, which every refusal leaves ---- */

static void set_scheme(struct gm_arena *arena, struct gm_request *request, struct gm_lane_spec *spec,
                       const char *name)
{
    char message[GM_MESSAGE];
    bool unreadable = false;
    spec->scheme = gm_scheme_named(name, &unreadable, message);
    if (!spec->scheme && message[0]) {
        request->refusal = unreadable ? GM_EXIT_FILE : GM_EXIT_USAGE;
    } else if (!spec->scheme) {
        gm_scheme_refuse(request->scene, name, message);
    }
    gm_arena_check(arena, spec->scheme, message);
}

/* Applies value `index` of a list to a lane; some common keys are not the lane's. */
static void apply(struct gm_arena *arena, struct gm_request *request, struct gm_lane_spec *spec,
                  const struct gm_word *list, size_t index)
{
    char formatted[GM_TEXT_SIZE], message[GM_MESSAGE], number[48];
    const char *text = gm_word_value(list, index, formatted);
    double steps = 0;
    if (strcmp(list->key, "scheme") == 0) {
        set_scheme(arena, request, spec, text);
        return;
    }
    if (strcmp(list->key, "steps") == 0) {
        gm_arena_refuse_if(arena,
                           !gm_number_parse(text, &steps) ||
                               !(steps >= 0 && steps <= (double)GM_MOST_STEPS) || steps != floor(steps),
                           "steps=%.60s is not a whole number from 0 to 1e15", text);
        spec->steps = (int64_t)steps;
        return;
    }
    const struct gm_parameter *parameter = gm_scene_parameter(request->scene, list->key);
    const struct gm_parameter *row = parameter ? parameter : gm_setting_find(list->key);
    const bool read = !row || gm_value_read(row, gm_lane_owner(spec, row), text, message);
    if (!read && row->type == GM_REAL && list->piece_count == list->count &&
        gm_words_decimal_comma(list, index, number, sizeof number)) {
        gm_append(message, GM_MESSAGE, "; " GM_DECIMAL_POINT, number);
    }
    gm_arena_check(arena, read, message);
}

/* Appends "Δt = 0.1" for a key and its value, or a scheme's title, to a name. */
static void add_name(const struct gm_word *list, size_t index, const struct gm_scheme *scheme, char *name,
                     size_t size)
{
    char value[GM_TEXT_SIZE];
    const char *comma = name[0] ? ", " : "";
    if (strcmp(list->key, "scheme") == 0) {
        gm_append(name, size, "%s%s", comma, scheme->title);
    } else {
        gm_append(name, size, "%s%s = %s", comma, gm_key_symbol(list->key), gm_word_name(list, index, value));
    }
}

static const char all_lanes[] = "all lanes";

void gm_show_in_order(struct gm_shown *shown, size_t lane, const struct gm_scheme *scheme, bool overlay)
{
    const char *panel = strcmp(shown->panel_name, all_lanes) == 0 ? "" : shown->panel_name;
    const char *colour = shown->colour_name;
    const bool untitled = !panel[0] && strncmp(colour, scheme->title, strlen(scheme->title)) != 0;
    char name[2 * sizeof shown->panel_name + sizeof ", "];
    snprintf(name, sizeof name, "%s%s%s", untitled ? scheme->title : panel,
             (untitled || panel[0]) && colour[0] ? ", " : "", colour);
    *shown = (struct gm_shown){.panel = overlay ? 0 : lane, .colour = lane, .dash = lane};
    memcpy(overlay ? shown->colour_name : shown->panel_name, name,
           strnlen(name, sizeof shown->panel_name - 1)); /* the rest is zero */
    if (overlay) {
        snprintf(shown->panel_name, sizeof shown->panel_name, "%s", all_lanes);
    } else if (strcmp(shown->panel_name, scheme->title) == 0) {
        shown->panel_name[0] = '\0';
    }
}

/* The first list of several values gives the panels, the others the colours; zipped, a lane has a panel named
   after all of them. */
static void show(const struct gm_words *words, size_t lane, struct gm_lane_spec *spec)
{
    struct gm_shown *shown = &spec->shown;
    *shown = (struct gm_shown){.panel = lane, .colour = lane};
    bool panels = false, colours = false; /* named already */
    for (size_t i = 0; i < words->count; i++) {
        const struct gm_word *list = &words->list[i];
        if (list->count == 1) {
            continue;
        }
        const size_t index = gm_words_choice(words, i, lane);
        if (!panels || words->zip) {
            panels = true;
            add_name(list, index, spec->scheme, shown->panel_name, sizeof shown->panel_name);
            shown->panel = words->zip ? lane : index;
        } else {
            shown->colour = colours ? shown->colour * list->count + index : index;
            colours = true;
            add_name(list, index, spec->scheme, shown->colour_name, sizeof shown->colour_name);
        }
    }
    shown->dash = colours ? shown->panel : shown->colour;
    if (strcmp(shown->panel_name, spec->scheme->title) == 0) {
        shown->panel_name[0] = '\0'; /* "" means the scheme's title */
    }
}

bool gm_ends_exactly(const struct gm_scheme *scheme)
{
    return scheme && scheme->family->kind == &gm_kind_ode && !scheme->family->adaptive;
}

/* dt and until, or steps, to steps; with `steps` until follows. */
static void settle_time(struct gm_arena *arena, const struct gm_scene *scene, struct gm_lane_spec *spec,
                        bool steps_given)
{
    struct gm_timing *timing = spec->parameters;
    const double t0 = gm_scene_t0(scene, spec->parameters);
    spec->until = steps_given ? NAN : timing->until;
    if (spec->scheme && spec->scheme->family->adaptive) {
        timing->until = steps_given ? GM_NEVER : timing->until;
        spec->steps = steps_given ? spec->steps : GM_MOST_STEPS;
        spec->end = timing->until;
        return;
    }
    bool shortened = false;
    if (!steps_given) {
        const double exactly = (timing->until - t0) / timing->dt, whole = round(exactly);
        shortened = gm_ends_exactly(spec->scheme) && fabs(exactly - whole) > 1e-9 * fmax(1, fabs(exactly));
        const double steps = shortened && exactly > whole ? whole + 1 : whole;
        gm_arena_refuse_if(arena, whole < 0, "until=%g lies before the start, t = %g", timing->until, t0);
        if (!(steps <= (double)GM_MOST_STEPS)) {
            gm_arena_refuse(arena, "until / dt is %.3g steps; 1e15 is the most", steps);
        }
        spec->steps = (int64_t)steps;
    }
    spec->end = shortened ? timing->until : t0 + (double)spec->steps * timing->dt;
    timing->until = steps_given ? spec->end : timing->until;
}

/* True unless a scheme has no use for a key. */
static bool takes(const struct gm_scene *scene, const struct gm_scheme *scheme, const char *key)
{
    const struct gm_parameter *row = gm_setting_find(key);
    return gm_scene_parameter(scene, key) ? !scene->takes || scene->takes(scheme, key)
                                          : !row || gm_scheme_takes(scheme, row);
}

/* True if the scheme of a lane has a use for a key. */
static bool is_taken(const struct gm_request *request, const char *key)
{
    bool taken = false;
    for (size_t k = 0; k < request->count && !taken; k++) {
        taken = takes(request->scene, request->lanes[k].scheme, key);
    }
    return taken;
}

/* Checks that a key is given only to schemes of which one has a use for it. */
static void check_settings(struct gm_arena *arena, const struct gm_request *request,
                           const struct gm_words *words)
{
    const struct gm_scene *scene = request->scene;
    for (size_t i = 0; i < words->count; i++) {
        const char *key = words->list[i].key;
        if (is_taken(request, key)) {
            continue;
        }
        const struct gm_scheme *fitting[GM_FITTING_SCHEMES];
        const size_t count = gm_fitting_schemes(scene, fitting);
        const char *names = "";
        for (size_t k = 0; k < count; k++) {
            if (takes(scene, fitting[k], key)) {
                names = gm_arena_print(arena, "%s%s%s", names, names[0] ? ", " : "", fitting[k]->name);
            }
        }
        gm_arena_refuse_if(arena, names[0], "none of these schemes takes %s=; these do: %s", key, names);
        gm_arena_refuse(arena, "no scheme that fits scene %s takes %s=", scene->name, key);
    }
}

/* The reason why a key has no effect in any lane, or NULL. */
static const char *why_idle(const struct gm_request *request, const char *key)
{
    const char *why = NULL;
    for (size_t k = 0; k < request->count && (k == 0 || why); k++) {
        why = gm_scene_idle(request->scene, request->lanes[k].parameters, key);
    }
    return why;
}

bool gm_request_uses(const struct gm_request *request, const char *key)
{
    return !why_idle(request, key) && is_taken(request, key);
}

/* Refuses a key without effect in any lane: the user expects one. */
static void check_effects(struct gm_arena *arena, struct gm_request *request, const struct gm_words *words)
{
    for (size_t i = 0; i < words->count; i++) {
        const char *key = words->list[i].key, *why = why_idle(request, key);
        if (why) {
            snprintf(request->refused, sizeof request->refused, "%s", key);
            gm_arena_refuse(arena, "%s= has no effect here: %s", key, why);
        }
    }
}

/* The lane that differs from `lane` in its scheme alone, and has the first one. */
static size_t first_scheme(const struct gm_words *words, size_t lane)
{
    if (words->zip) {
        return 0;
    }
    for (size_t other = 0; other < lane; other++) {
        bool same = true;
        for (size_t i = 0; i < words->count; i++) {
            same = same && (strcmp(words->list[i].key, "scheme") == 0 ||
                            gm_words_choice(words, i, other) == gm_words_choice(words, i, lane));
        }
        if (same) {
            return other;
        }
    }
    return lane;
}

static bool is_repeated(const struct gm_request *request, size_t lane)
{
    for (size_t i = 0; i < lane; i++) {
        if (memcmp(request->lanes[i].parameters, request->lanes[lane].parameters, request->scene->size) ==
            0) {
            return true;
        }
    }
    return false;
}

/* Finds the fitting one of the schemes with a name; a problem is set up once for all its lanes. */
static void find_schemes(struct gm_arena *arena, struct gm_request *request)
{
    char message[GM_MESSAGE], sentence[GM_MESSAGE], words[256];
    const struct gm_scene *scene = request->scene;
    const struct gm_scheme *unfit = NULL;
    const char *lacks = NULL;
    for (size_t i = 0; i < request->count && !unfit; i++) {
        struct gm_problem problem = {0};
        if (is_repeated(request, i)) {
            continue;
        }
        if (!scene->setup(request->lanes[i].parameters, &problem, message)) {
            if (scene->readable && !scene->readable(request->lanes[i].parameters, sentence)) {
                request->refusal = GM_EXIT_FILE;
            }
            gm_arena_refuse(arena, "%s", message);
        }
        for (size_t k = i; k < request->count && !unfit; k++) {
            struct gm_lane_spec *spec = &request->lanes[k];
            if (memcmp(spec->parameters, request->lanes[i].parameters, scene->size) == 0) {
                spec->scheme = gm_scheme_find_for(spec->scheme->name, &problem);
                unfit = gm_scheme_fits(spec->scheme, &problem) ? NULL : spec->scheme;
                lacks = unfit ? gm_scheme_lacks(unfit, &problem) : NULL;
                const size_t column = unfit ? gm_parts_column(unfit, &problem) : 0;
                request->unfit_offset = column > 0 ? column - 1 : 0;
            }
        }
        if (scene->close) {
            scene->close(&problem);
        }
    }
    request->unfit = unfit;
    if (unfit) {
        gm_arguments_tell_scene(scene, words, sizeof words);
        gm_arena_refuse(arena,
                        "scheme %s does not fit scene %s%s%s; geomint list %s --long names those that do",
                        unfit->name, scene->name, lacks ? ": it needs " : "", lacks ? lacks : "", words);
    }
}

/* Evaluations per model time over the first steps. */
static double rate_of(struct gm_arena *arena, const struct gm_request *request, size_t index)
{
    enum { STEPS = 32 };
    char message[GM_MESSAGE];
    const size_t mark = gm_arena_mark(arena);
    struct gm_lane *lane = gm_lane_in(arena, gm_request_open_lane(request, index, message), message);
    /* starting a scheme with memory may cost evaluations that no later step does */
    gm_run_advance(lane->run, 1);
    const unsigned long before = lane->run->evaluations;
    const double t = lane->run->t;
    gm_run_advance(lane->run, STEPS);
    const double rate = (double)(lane->run->evaluations - before) / fabs(lane->run->t - t);
    gm_arena_refuse_if(arena, !(rate > 0) || !isfinite(rate),
                       "equal=cost compares evaluations, and %s counts none over its first %d steps",
                       lane->scheme->name, STEPS);
    gm_arena_release(arena, mark);
    return rate;
}

/* Scales lane `index`'s dt so that it makes as many evaluations per model time as lane `like`, measured
   over some steps from its start, and adds the step size to the lane's name. */
static void equal_cost(struct gm_arena *arena, struct gm_request *request, size_t index, size_t like)
{
    struct gm_lane_spec *spec = &request->lanes[index];
    struct gm_timing *timing = spec->parameters;
    const struct gm_parameter *row = gm_scene_parameter(request->scene, "dt");
    const double wanted = rate_of(arena, request, like);
    /* the evaluations per step of an implicit scheme depend on the step size */
    enum { ROUNDS = 4 };
    for (int round = 0; round < ROUNDS && index != like; round++) {
        timing->dt *= rate_of(arena, request, index) / wanted;
        gm_arena_refuse_if(arena, !(timing->dt >= row->lowest && timing->dt <= row->highest),
                           "equal=cost asks for dt = %.3g of %s, which lies beyond %g to %g", timing->dt,
                           spec->scheme->name, row->lowest, row->highest);
    }
    struct gm_shown *shown = &spec->shown;
    char *name = shown->colour_name[0] ? shown->colour_name : shown->panel_name;
    const size_t size = shown->colour_name[0] ? sizeof shown->colour_name : sizeof shown->panel_name;
    const char *text = gm_arena_print(arena, "%s, Δt %.3g", name[0] ? name : spec->scheme->title, timing->dt);
    if (strlen(text) < size) { /* the name alone is better than a cut text */
        memcpy(name, text, strlen(text) + 1);
    }
}

/* The lanes of the product, each with the parameters that its choice of the words gives. */
static void apply_words(struct gm_arena *arena, struct gm_request *request, const struct gm_words *words,
                        size_t count)
{
    char message[GM_MESSAGE];
    const struct gm_scene *scene = request->scene;
    const bool steps_given = gm_words_find(words, "steps") != NULL;
    const char *keys[GM_MOST_WORDS] = {NULL};
    for (size_t i = 0; i < words->count && i < GM_MOST_WORDS; i++) {
        keys[i] = words->list[i].key;
    }
    for (size_t k = 0; k < count; k++) {
        struct gm_lane_spec *spec = &request->lanes[k];
        spec->parameters = gm_scene_defaults(scene);
        request->count++;
        gm_arena_need(arena, spec->parameters);
        gm_parameters_reset(gm_settings_parameters, gm_settings_parameter_count, &spec->settings);
        for (size_t i = 0; i < words->count; i++) {
            snprintf(request->refused, sizeof request->refused, "%s", keys[i]);
            apply(arena, request, spec, &words->list[i], gm_words_choice(words, i, k));
        }
        request->refused[0] = '\0';
        gm_arena_check(arena, !scene->settle || scene->settle(spec->parameters, keys, words->count, message),
                       message);
        settle_time(arena, scene, spec, steps_given);
    }
}

/* Refuses steps= with until=, with the common step size if each is one number. */
static void refuse_two_ends(struct gm_arena *arena, const struct gm_scene *scene, const struct gm_word *steps,
                            const struct gm_word *until)
{
    char texts[2][GM_TEXT_SIZE];
    const char *both = "", *first = gm_word_value(steps, 0, texts[0]),
               *second = gm_word_value(until, 0, texts[1]);
    double count, end;
    void *usual = gm_arena_keep(arena, gm_scene_defaults(scene), free);
    if (steps->count == 1 && until->count == 1 && gm_number_parse(first, &count) &&
        gm_number_parse(second, &end) && count > 0) {
        both = gm_arena_print(arena, ", or until=%.40s dt=%.6g for both", second,
                              (end - gm_scene_t0(scene, usual)) / count);
    }
    gm_arena_refuse(arena, "steps=%.40s and until=%.40s are both given; type one of them%s", first, second,
                    both);
}

/* The words behind the scene while they become lanes. */
struct making {
    struct gm_request *request;
    struct gm_words words;
    bool recalled;
};

static void make_lanes(struct gm_arena *arena, void *data)
{
    const struct making *making = data;
    struct gm_request *request = making->request;
    const struct gm_words *words = &making->words;
    const struct gm_word *steps = gm_words_find(words, "steps"), *until = gm_words_find(words, "until");
    char message[GM_MESSAGE];
    size_t count = 0;
    gm_arena_check(arena, gm_words_count(words, GM_MOST_REQUESTED, &count, message), message);
    request->overlay = gm_words_chosen(words, "overlay");
    gm_arena_refuse_if(arena, request->overlay && count > GM_LANE_COLOURS,
                       "overlay=yes takes up to %d lanes, a colour for each; these are %zu", GM_LANE_COLOURS,
                       count);
    request->lanes = calloc(count, sizeof *request->lanes);
    gm_arena_need(arena, request->lanes);
    if (steps && until) {
        refuse_two_ends(arena, request->scene, steps, until);
    }
    apply_words(arena, request, words, count);
    if (!making->recalled) {
        check_effects(arena, request, words);
    }
    find_schemes(arena, request);
    for (size_t k = 0; k < count; k++) {
        struct gm_lane_spec *spec = &request->lanes[k];
        show(words, k, spec); /* rows of one name may have different titles */
        if (request->overlay) {
            gm_show_in_order(&spec->shown, k, spec->scheme, true);
        }
    }
    const bool equal =
        gm_words_chosen(words, "equal"); /* each step size so that the cost is the first scheme's */
    gm_arena_refuse_if(arena, equal && steps,
                       "equal=cost scales the steps up to until=; steps= cannot be given with it");
    for (size_t k = 0; k < count && equal; k++) {
        equal_cost(arena, request, k, first_scheme(words, k));
        settle_time(arena, request->scene, &request->lanes[k], false);
    }
    check_settings(arena, request, words);
    request->arguments = gm_words_join(request->scene, words);
    gm_arena_need(arena, request->arguments);
}

const struct gm_scene *gm_request_scene(int count, char *const words[], int *status, char *message)
{
    const struct gm_scene *scene = gm_scene_of_words(count, words);
    *status = GM_EXIT_USAGE;
    if (scene && scene->parameter_count == 0) { /* its file could not be opened */
        *status = gm_memory_was_short() ? GM_EXIT_MEMORY : GM_EXIT_FILE;
        scene->setup(NULL, NULL, message);
        return NULL;
    }
    if (!scene && gm_system_is(words[0])) {
        return gm_system_scene(count, words, status, message);
    }
    const size_t name = strcspn(words[0], "='");
    if (!scene && (gm_typed_is_formula(words[0]) || words[0][name] == '\'')) {
        gm_refuse(message, "a formula is for the scene system: system %.60s", words[0]);
    } else if (!scene && words[0][name]) {
        gm_refuse(message, "the scene comes before %.60s, as kepler in: geomint run kepler dt=0.01",
                  words[0]);
    } else if (!scene) {
        char near[GM_NEAR_NAMES], folder[GM_MESSAGE];
        if (gm_system_near(words[0], near, folder)) {
            gm_refuse(message, "there is no scene \"%.40s\"; did you mean %s", words[0], near);
        } else if (folder[0]) {
            *status = GM_EXIT_FILE;
            gm_refuse(message, "there is no scene \"%.40s\": %.400s", words[0], folder);
        } else {
            gm_refuse(message, "there is no scene \"%.40s\"; see geomint list", words[0]);
        }
    }
    return scene;
}

/* The lanes of the words behind the scene: the given ones, or these and its default lanes. */
static bool read_words(struct gm_request *request, const struct gm_arguments *given,
                       const struct gm_arguments *all, size_t schemes, bool recalled, char *message)
{
    struct making making = {.request = request, .recalled = recalled};
    struct gm_words *words = &making.words;
    size_t lanes;
    bool made = gm_words_read(words, request->scene, all->count - 1, all->words + 1, schemes, message);
    if (!made) {
        memcpy(request->refused, words->refused, sizeof request->refused);
    }
    struct gm_word *overlay = made ? (struct gm_word *)gm_words_find(words, "overlay") : NULL;
    if (overlay && all != given && !gm_arguments_have(given, "overlay=") &&
        !gm_words_count(words, GM_LANE_COLOURS, &lanes, message)) {
        overlay->pieces[0].text = "no"; /* there are more lanes than colours */
    }
    made = made && (gm_arena_run(words->arena, make_lanes, &making) ||
                    gm_refuse(message, "%s", gm_arena_reason(words->arena)));
    gm_words_close(words);
    return made;
}

/* `scene`: the one that the first word names; NULL: it is found. */
static bool parse(struct gm_request *request, const struct gm_scene *scene, const struct gm_arguments *given,
                  size_t schemes, bool recalled, char *message)
{
    *request = (struct gm_request){0};
    if (given->count == 0) {
        return gm_refuse(message, "which scene? geomint list names them");
    }
    request->scene = scene ? scene : gm_request_scene(given->count, given->words, &request->refusal, message);
    if (!request->scene) {
        return false;
    }
    /* a scene shows its default lanes, except for typed words */
    struct gm_arguments arguments = {0};
    const bool shown = schemes > GM_RUN_SCHEMES && request->scene->lanes;
    if (shown && !gm_words_complete(&arguments, request->scene, given, request->scene->lanes)) {
        gm_arguments_close(&arguments);
        return gm_refuse(message, "not enough memory");
    }
    const unsigned long refusals = gm_memory_refusals();
    bool made = read_words(request, given, shown ? &arguments : given, schemes, recalled, message);
    /* a lack of memory may appear as a fault of a mesh or of its file */
    if (gm_memory_refusals() != refusals) {
        made = gm_refuse(message, "not enough memory");
        request->refusal = GM_EXIT_FILE;
    }
    gm_arguments_close(&arguments);
    char key[sizeof request->refused + 1];
    snprintf(key, sizeof key, "%s=", request->refused);
    if (!made && shown && !gm_arguments_have(given, key) && (given->count == 1 || request->refused[0])) {
        char sentence[GM_MESSAGE]; /* a word that was not typed is from a file */
        snprintf(sentence, sizeof sentence, "%s", message);
        gm_refuse(message, "in the line \"lanes:\" of %.80s: %.400s", request->scene->name, sentence);
    }
    if (!made) {
        const struct gm_request refused = *request;
        gm_request_close(request);
        *request = (struct gm_request){
            .refusal = refused.refusal, .unfit = refused.unfit, .unfit_offset = refused.unfit_offset};
        memcpy(request->refused, refused.refused, sizeof refused.refused);
    }
    return made;
}

bool gm_request_parse(struct gm_request *request, int count, char *const words[], size_t schemes,
                      char *message)
{
    return gm_request_parse_for(request, NULL, count, words, schemes, message);
}

bool gm_request_parse_for(struct gm_request *request, const struct gm_scene *scene, int count,
                          char *const words[], size_t schemes, char *message)
{
    const struct gm_arguments given = {.words = (char **)words, .count = count};
    return parse(request, scene, &given, schemes, false, message);
}

/* True if the file that defines the scene has the name of this one, in whatever folder. */
static bool have_one_file(const struct gm_scene *scene, const char *word)
{
    return scene && scene->words && !scene->words[1] &&
           strcmp(basename(scene->words[0]), basename(word)) == 0;
}

bool gm_request_recall(struct gm_request *request, const struct gm_scene *shown, const char *arguments,
                       char *message)
{
    struct gm_arguments words = {0};
    *request = (struct gm_request){0};
    const bool split = gm_arguments_split(&words, arguments);
    const struct gm_scene *scene =
        split && words.count > 0 && have_one_file(shown, words.words[0]) ? shown : NULL;
    const bool recalled =
        split ? parse(request, scene, &words, 1, true, message) : gm_refuse(message, "not enough memory");
    gm_arguments_close(&words);
    return recalled;
}

bool gm_request_ends_together(const struct gm_request *request, char *message)
{
    for (size_t i = 1; i < request->count; i++) {
        if (isnan(request->lanes[i].until) && request->lanes[i].end != request->lanes[0].end) {
            return gm_refuse(message,
                             "steps= ends the runs at t = %.6g and t = %.6g; until= ends them together",
                             request->lanes[0].end, request->lanes[i].end);
        }
    }
    return true;
}

int gm_request_refusal(const struct gm_request *request)
{
    return request->refusal ? request->refusal : GM_EXIT_USAGE;
}

void gm_changes_drop(struct gm_request *request,
                     bool (*drops)(const struct gm_change *change, const void *data), const void *data)
{
    size_t kept = 0;
    for (size_t i = 0; i < request->change_count; i++) {
        const struct gm_change change = request->changes[i];
        if (!drops || drops(&change, data)) {
            free(change.text);
        } else {
            request->changes[kept++] = change;
        }
    }
    request->change_count = kept;
    if (!drops) {
        free(request->changes);
        request->changes = NULL;
    }
}

void gm_request_close(void *self)
{
    struct gm_request *request = self;
    for (size_t i = 0; i < request->count; i++) {
        free(request->lanes[i].parameters);
    }
    free(request->lanes);
    gm_changes_drop(request, NULL, NULL);
    free(request->arguments);
    *request = (struct gm_request){0};
}

void *gm_parameters_copy(const struct gm_scene *scene, const void *parameters)
{
    void *copy = malloc(scene->size);
    if (copy) {
        memcpy(copy, parameters, scene->size);
    }
    return copy;
}

double gm_request_steps(const struct gm_request *request, size_t index)
{
    const struct gm_lane_spec *spec = &request->lanes[index];
    return spec->scheme && spec->scheme->family->adaptive ? 0 : (double)spec->steps;
}

struct gm_lane *gm_request_open_lane(const struct gm_request *request, size_t index, char *message)
{
    const struct gm_lane_spec *spec = &request->lanes[index];
    struct gm_lane *lane =
        gm_lane_open(request->scene, spec->parameters, &spec->settings, spec->scheme, message);
    if (lane) {
        gm_lane_show(lane, &spec->shown);
        gm_engine_meet(lane);
    }
    return lane;
}

struct gm_lane *gm_lane_in(struct gm_arena *arena, struct gm_lane *lane, const char *message)
{
    gm_arena_check(arena, lane, message);
    return gm_arena_keep(arena, lane, gm_lane_close);
}
