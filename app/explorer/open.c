/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Opens and leaves scenes, and handles typed lines: a user-defined system or scheme, or a map of many
   runs. */
#include "app/explorer/events.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/base/arguments.h"
#include "app/explorer/surface/surface.h"
#include "app/explorer/view/view.h"
#include "app/grid/grid.h"
#include "app/words/typed_file.h"
#include "core/basics.h"
#include "core/model/equations.h"
#include "core/schemes.h"
#include "render/cells/text.h"
#include "render/message.h"

enum { FIRST_SCHEMES = 3, LOOK_SCHEMES = 2 };

void gm_open_leave(struct gm_open *open)
{
    char parting[GM_MESSAGE] = "", *before = open->partings, *longer = NULL;
    gm_display_finish(open->display);
    if (open->touring) {
        gm_worker_close(open->worker, parting); /* the worker must end before its tour is freed */
    } else if (open->worker) {
        gm_worker_abandon(open->worker, parting);
    }
    open->worker = NULL;
    open->touring = false;
    if (parting[0] && asprintf(&longer, "%sgeomint: %s\n", before ? before : "", gm_text_tame(parting)) > 0) {
        open->partings = longer;
        free(before);
    }
}

/* Replaces the open scene by lanes that a new worker plays. Returns false and fills message on failure. */
static bool take_over(struct gm_open *open, const struct gm_worker_plan *plan, char *message)
{
    struct gm_worker *worker = gm_worker_open(plan, open->wake, message);
    if (!worker) {
        return false;
    }
    gm_open_leave(open);
    open->worker = worker;
    open->scene = plan->request ? plan->request->scene : NULL;
    const char *name = !open->scene         ? plan->name
                       : open->scene->words ? open->scene->words[0]
                                            : open->scene->name;
    snprintf(open->name, sizeof open->name, "%s", name);
    open->shot = NULL;
    open->told = 0;
    open->asked = true;
    open->next_shot = 0;
    open->said[0] = '\0';
    return true;
}

bool gm_open_request(struct gm_open *open, const struct gm_request *request, char *message)
{
    return take_over(open, &(struct gm_worker_plan){.request = request}, message);
}

bool gm_open_named(struct gm_open *open, const char *name, bool preview, char *message)
{
    const size_t schemes = preview ? LOOK_SCHEMES : FIRST_SCHEMES;
    return take_over(open, &(struct gm_worker_plan){.name = name, .schemes = schemes, .preview = preview},
                     message);
}

void gm_open_study(struct gm_open *open)
{
    const struct gm_guide *guide = &open->guide;
    const struct gm_tour_step *step = &guide->tour->steps[guide->step];
    open->studies.shown = GM_STUDY_NONE;
    if (step->study != GM_STUDY_NONE && guide->answered) {
        const struct gm_request *request =
            &guide->tour->steps[gm_tour_first(guide->tour, guide->step)].request;
        gm_studies_open(&open->studies, step->study, request->scene, step->study_words, open->wake);
    }
}

bool gm_open_step(struct gm_open *open, char *message)
{
    const struct gm_guide *guide = &open->guide;
    const struct gm_order first = {
        .kind = GM_ORDER_TOUR, .amount = !guide->answered, .tour = guide->tour, .step = guide->step};
    const struct gm_request *request = &guide->tour->steps[gm_tour_first(guide->tour, guide->step)].request;
    if (!take_over(open, &(struct gm_worker_plan){.request = request, .first = &first}, message)) {
        return false;
    }
    gm_open_study(open);
    open->touring = true;
    return true;
}

/* ---- faults of a line, found by a thread: a sum may have many terms ---- */

static void find_out(void *self)
{
    struct gm_check *check = self;
    check->read(check->line, &check->fault);
}

/* Returns true if the line's fault is known. Otherwise checks the line, unless another one is being
   checked; `wake` is written at the end. */
static bool knows_fault(struct gm_check *check, gm_line_reader *read, const char *line, int wake,
                        struct gm_typed_fault *fault)
{
    if (check->open && gm_job_is_busy(&check->job)) {
        return false;
    }
    if (!check->line || check->read != read || strcmp(check->line, line) != 0) {
        free(check->line);
        check->line = strdup(line);
        check->read = read;
        check->fault = (struct gm_typed_fault){.at = -1};
        char message[GM_MESSAGE];
        check->open = check->open || gm_job_open(&check->job, find_out, NULL, check, wake, message);
        if (check->line && check->open) {
            gm_job_begin(&check->job);
            return false;
        }
        gm_refuse(check->fault.sentence, "%s", check->line ? message : "There is not enough memory.");
    }
    *fault = check->fault;
    return true;
}

/* ---- typed lines ---- */

static const char example[] = "H=p^2/2 - cos(q) q=2 p=0";

static void open_prompt(struct gm_explorer *explorer, enum gm_typed_kind kind, const char *text, size_t at)
{
    struct gm_typed_prompt *prompt = &explorer->typed_prompt;
    prompt->kind = kind;
    prompt->checked = prompt->entered = false;
    prompt->fault = (struct gm_typed_fault){.at = -1};
    gm_edit_set(&prompt->line, text, at);
    explorer->dirty = explorer->fresh = true;
    gm_explorer_check_typed(explorer);
}

static void close_prompt(struct gm_explorer *explorer)
{
    struct gm_typed_prompt *prompt = &explorer->typed_prompt;
    free(prompt->last[prompt->kind]);
    prompt->last[prompt->kind] = strdup(prompt->line.text);
    prompt->kind = GM_TYPED_NONE;
    explorer->dirty = explorer->fresh = true;
}

/* Returns an example: three steps of a suitable scheme, one of them backwards, or two stages. */
static const char *scheme_example(const struct gm_shot *shot)
{
    static const char *const examples[][2] = {
        {"verlet", "composition(verlet; 1/(2 - 2^(1/3)), 1 - 2/(2 - 2^(1/3)), 1/(2 - 2^(1/3)))"},
        {"midpoint", "composition(midpoint; 1/(2 - 2^(1/3)), 1 - 2/(2 - 2^(1/3)), 1/(2 - 2^(1/3)))"},
    };
    for (size_t k = 0; k < GM_COUNT(examples); k++) {
        for (size_t i = 0; i < shot->scheme_count; i++) {
            if (strcmp(shot->schemes[i]->name, examples[k][0]) == 0) {
                return examples[k][1];
            }
        }
    }
    return "runge-kutta(0, 0 | 2/3, 0; 1/4, 3/4)";
}

/* Asks for a system. If one is open, the worker first sends its command line. */
void gm_explorer_ask_system(struct gm_explorer *explorer)
{
    const struct gm_open *open = &explorer->open;
    const char *last = explorer->typed_prompt.last[GM_TYPED_SYSTEM];
    if (open->shot && open->scene->text) {
        explorer->editing = explorer->face.awaited = true;
        gm_explorer_order(explorer, (struct gm_order){.kind = GM_ORDER_TELL});
        return;
    }
    const size_t formula = (size_t)(strstr(example, " q=") - example);
    open_prompt(explorer, GM_TYPED_SYSTEM, last ? last : example, last ? SIZE_MAX : formula);
}

void gm_explorer_edit_system(struct gm_explorer *explorer, const char *command)
{
    struct gm_arguments typed = {0}, words = {0}, formulas = {0};
    gm_typed_split(&typed, command ? command : "");
    explorer->editing = false;
    /* omits the program's name and `system`; after a file's name come its formulas */
    const bool formula = typed.count > 1 && strcmp(typed.words[1], "system") == 0;
    if (typed.count > 1 && !formula) {
        gm_arguments_add(&words, typed.words[1]);
        gm_typed_file_formulas(explorer->open.scene->text, &formulas);
    }
    gm_arguments_append(&words, formulas.words, formulas.count);
    for (int i = 2; i < typed.count; i++) {
        if (!gm_arguments_have(&formulas, typed.words[i])) {
            gm_arguments_add(&words, typed.words[i]);
        }
    }
    const bool failed = typed.failed || words.failed || formulas.failed || typed.count < 2;
    char *text = failed ? NULL : gm_typed_join(&words);
    if (text) { /* the cursor is after the first formula */
        size_t at = words.count > 0 ? strlen(words.words[0]) : 0;
        at += !formula && words.count > 1 ? 1 + strlen(words.words[1]) : 0;
        open_prompt(explorer, GM_TYPED_SYSTEM, text, at);
    }
    free(text);
    gm_arguments_close(&typed);
    gm_arguments_close(&words);
    gm_arguments_close(&formulas);
}

/* ---- maps ---- */

/* Returns a typed line as words of the command `sweep`. The caller frees them; NULL when out of memory. */
static char *sweep_words(const char *line)
{
    static const char measure[] = "measure=";
    struct gm_arguments typed = {0};
    struct gm_text_stream writing = {0};
    FILE *stream = gm_typed_split(&typed, line) ? gm_stream_begin(&writing) : NULL;
    if (stream && typed.count > 0 && strchr(typed.words[0], '=')) {
        fputs("system ", stream);
    }
    for (int i = 0; stream && i < typed.count; i++) {
        const char *word = typed.words[i];
        const bool measured = strncmp(word, measure, strlen(measure)) == 0;
        fputs(measured ? "--measure " : "", stream);
        gm_arguments_put(stream, word + (measured ? strlen(measure) : 0));
        fputc(' ', stream);
    }
    gm_arguments_close(&typed);
    return gm_stream_end(&writing);
}

static bool check_map(const char *line, struct gm_typed_fault *fault)
{
    char *text = sweep_words(line);
    struct gm_arguments words = {0};
    struct gm_grid grid;
    *fault = (struct gm_typed_fault){.at = -1};
    const bool opens = text && gm_arguments_split(&words, text)
                           ? gm_grid_open(&grid, GM_STUDY_SWEEP, &words, NULL, fault->sentence)
                           : gm_refuse(fault->sentence, "There is not enough memory.");
    if (opens) {
        gm_grid_close(&grid);
    }
    gm_arguments_close(&words);
    free(text);
    return opens;
}

/* Writes the range of a swept number: half its value to both sides. Returns false if it cannot be swept. */
static bool range_of(const struct gm_shot_parameter *parameter, char *word, size_t size)
{
    enum { ACROSS = 24 };
    const struct gm_parameter *row = parameter->row;
    double value;
    if (row->type != GM_REAL || row->automatic || parameter->of_scheme || strcmp(row->key, "dt") == 0 ||
        strcmp(row->key, "until") == 0 || !gm_number_parse(parameter->value, &value)) {
        return false;
    }
    const double reach = value != 0 ? 0.5 * fabs(value) : 0.5;
    const bool low = value - reach<row->lowest, high = value + reach> row->highest;
    snprintf(word, size, "%s=%.*g..%.*g:%d", row->key, low ? DBL_DECIMAL_DIG : 4,
             low ? row->lowest : value - reach, high ? DBL_DECIMAL_DIG : 4,
             high ? row->highest : value + reach, ACROSS);
    return true;
}

/* Returns a map of the open scene with the selected lane's scheme, over the chosen parameter and the next
   number. The caller frees it; NULL when out of memory. */
static char *map_example(const struct gm_explorer *explorer)
{
    const struct gm_shot *shot = explorer->open.shot;
    struct gm_arguments present = {0}, words = {0};
    char ranges[2][64 + GM_TEXT_SIZE], *said = gm_studies_words(shot), *text = NULL;
    size_t axes = 0;
    for (size_t i = 0; i < shot->parameter_count && axes < 2; i++) {
        const size_t at = (explorer->face.parameter + i) % shot->parameter_count;
        axes += range_of(&shot->parameters[at], ranges[axes], sizeof ranges[axes]);
    }
    gm_arguments_split(&present, said ? said : "");
    for (int i = 0; i < present.count; i++) {
        const size_t key = strcspn(present.words[i], "=") + 1;
        const bool swept = (axes > 0 && strncmp(present.words[i], ranges[0], key) == 0) ||
                           (axes > 1 && strncmp(present.words[i], ranges[1], key) == 0);
        gm_arguments_append(&words, &present.words[i], !swept);
    }
    gm_arguments_print(&words, "scheme=%.400s", gm_scheme_word(shot->lanes[shot->selected].scheme));
    for (size_t i = 0; i < axes; i++) {
        gm_arguments_add(&words, ranges[i]);
    }
    gm_arguments_print(&words, "measure=%.100s",
                       shot->scene->observable_count > 0 ? shot->scene->observables[0].key : "");
    text = said && !present.failed && !words.failed ? gm_typed_join(&words) : NULL;
    gm_arguments_close(&present);
    gm_arguments_close(&words);
    free(said);
    return text;
}

/* Opens the prompt with the last line for this scene, or an example. */
void gm_explorer_ask_map(struct gm_explorer *explorer)
{
    const char *last = explorer->typed_prompt.last[GM_TYPED_MAP];
    char *usual = map_example(explorer);
    const bool same = last && usual && strncmp(last, usual, strcspn(usual, " ") + 1) == 0;
    if (usual) {
        open_prompt(explorer, GM_TYPED_MAP, same ? last : usual, SIZE_MAX);
    }
    free(usual);
}

/* ---- invariants ---- */

/* Returns true if a word sets a parameter or a choice of the system. */
static bool sets_value(const struct gm_user_system *system, const char *word)
{
    char key[64];
    snprintf(key, sizeof key, "%.*s", (int)strcspn(word, "="), word);
    bool found = gm_choice_named(&system->choices, key) != NULL;
    for (size_t i = system->parameters; i < system->velocities; i++) {
        found = found || strcmp(system->variables[i].name, key) == 0;
    }
    return found;
}

/* Opens the page of the invariants that `geomint list` finds, for the scene's words and its system's values. */
void gm_explorer_ask_invariants(struct gm_explorer *explorer)
{
    const struct gm_shot *shot = explorer->open.shot;
    const char *text = shot->scene->text;
    struct gm_user_system system;
    struct gm_fault fault;
    struct gm_arguments present = {0}, words = {0};
    char *said = gm_studies_words(shot);
    gm_arguments_split(&present, said ? said : "");
    const bool opened = text && gm_equations_open(&system, text, strlen(text), NULL, 0, &fault);
    const bool typed =
        present.count > 0 && strcmp(present.words[0], "system") == 0; /* then all words may be given */
    int own = 1;                                                      /* words of the scene */
    while (shot->scene->words && shot->scene->words[own]) {
        own++;
    }
    for (int i = 0; i < present.count; i++) {
        gm_arguments_append(&words, &present.words[i],
                            i < own || typed || (opened && sets_value(&system, present.words[i])));
    }
    gm_arguments_add(&words, "--invariants");
    char *command = gm_arguments_join("list", &words);
    if (command) {
        gm_measure_ask(&explorer->measure, command);
        explorer->face.page = GM_PAGE_INVARIANTS;
        explorer->face.scroll = 0;
    }
    if (opened) {
        gm_system_close(&system);
    }
    free(command);
    free(said);
    gm_arguments_close(&present);
    gm_arguments_close(&words);
}

/* ---- accepted lines ---- */

static void take_scheme(struct gm_explorer *explorer, bool fork, const struct gm_scheme *scheme)
{
    const enum gm_order_kind kind = fork ? GM_ORDER_FORK : GM_ORDER_SWITCH;
    gm_explorer_order(explorer, (struct gm_order){.kind = kind, .scheme = scheme});
}

void gm_explorer_choose(struct gm_explorer *explorer, const struct gm_scheme *scheme)
{
    const bool fork = explorer->face.choosing == GM_CHOOSE_FORK;
    const enum gm_typed_kind kind = fork ? GM_TYPED_FORK : GM_TYPED_SWITCH;
    const struct gm_shot *shot = explorer->open.shot;
    explorer->face.choosing = GM_CHOOSE_NOTHING;
    if (scheme != &gm_chooser_user) {
        take_scheme(explorer, fork, scheme);
        return;
    }
    const struct gm_scheme *present = shot->lanes[shot->selected].scheme;
    const char *last = explorer->typed_prompt.last[kind], *usual = last ? last : scheme_example(shot);
    open_prompt(explorer, kind, present->word ? gm_scheme_word(present) : usual, SIZE_MAX);
}

bool gm_explorer_open_line(struct gm_explorer *explorer, const char *line, struct gm_typed_fault *fault)
{
    struct gm_open *open = &explorer->open;
    struct gm_request request;
    if (!gm_typed_request(&request, line, FIRST_SCHEMES, fault)) {
        return false;
    }
    const bool opened = gm_open_request(open, &request, fault->sentence);
    gm_request_close(&request);
    if (!opened) {
        return false;
    }
    open->guide.tour = NULL;
    open->studies.shown = GM_STUDY_NONE;
    explorer->face.guide = NULL;
    explorer->face.parameter = 0;
    explorer->list.shown = false;
    return true;
}

/* Carries out a correct line. */
static void take(struct gm_explorer *explorer)
{
    struct gm_typed_prompt *prompt = &explorer->typed_prompt;
    struct gm_open *open = &explorer->open;
    prompt->entered = false;
    const char *line = prompt->line.text;
    bool taken;
    if (prompt->kind == GM_TYPED_SYSTEM) {
        taken = gm_explorer_open_line(explorer, line, &prompt->fault);
        const bool formula = memchr(line, '=', strcspn(line, " ")) || strstr(line, " H=") ||
                             strstr(line, " L=") || strstr(line, " rate=");
        open->unsaved = open->unsaved || (taken && formula);
    } else if (prompt->kind == GM_TYPED_MAP) {
        char *words = sweep_words(line);
        taken = words && gm_studies_open(&open->studies, GM_STUDY_SWEEP, open->scene, words, open->wake);
        if (!taken) {
            snprintf(prompt->fault.sentence, sizeof prompt->fault.sentence, "%s",
                     words ? open->studies.notice : "There is not enough memory.");
        }
        free(words);
    } else {
        const struct gm_scheme *scheme;
        taken = gm_typed_scheme(line, &scheme, &prompt->fault);
        if (taken) {
            take_scheme(explorer, prompt->kind == GM_TYPED_FORK, scheme);
        }
    }
    if (taken) {
        close_prompt(explorer);
    }
}

void gm_explorer_check_typed(struct gm_explorer *explorer)
{
    static gm_line_reader *const readers[GM_TYPED_KINDS] = {[GM_TYPED_SYSTEM] = gm_typed_check,
                                                            [GM_TYPED_SWITCH] = gm_typed_check_scheme,
                                                            [GM_TYPED_FORK] = gm_typed_check_scheme,
                                                            [GM_TYPED_MAP] = check_map};
    struct gm_typed_prompt *prompt = &explorer->typed_prompt;
    if (prompt->kind == GM_TYPED_NONE || prompt->checked) {
        return;
    }
    const bool scheme = prompt->kind == GM_TYPED_SWITCH || prompt->kind == GM_TYPED_FORK;
    char *scene = scheme ? gm_studies_words(explorer->open.shot) : NULL, *line = NULL;
    if (asprintf(&line, "%s%s%s", scene ? scene : "", scheme ? "\n" : "", prompt->line.text) >= 0) {
        prompt->checked =
            knows_fault(&explorer->check, readers[prompt->kind], line, explorer->wake, &prompt->fault);
        free(line);
    }
    free(scene);
    explorer->dirty = explorer->dirty || prompt->checked;
    if (prompt->checked && prompt->entered) {
        if (prompt->fault.sentence[0]) {
            prompt->entered = false;
        } else {
            take(explorer);
        }
    }
}

void gm_explorer_press_typed(struct gm_explorer *explorer, int key)
{
    struct gm_typed_prompt *prompt = &explorer->typed_prompt;
    if (key == GM_KEY_ESCAPE) {
        close_prompt(explorer);
    } else if (key == '\n') {
        prompt->entered = !prompt->checked || !prompt->fault.sentence[0];
        if (prompt->checked && prompt->entered) {
            take(explorer);
        }
    } else {
        if (prompt->entered) { /* pasted text continues: its line end is a blank */
            gm_edit_press(&prompt->line, ' ');
        }
        prompt->entered = false;
        prompt->checked = !gm_edit_press(&prompt->line, key) && prompt->checked;
    }
}

void gm_explorer_close_typed(struct gm_explorer *explorer)
{
    if (explorer->check.open) {
        gm_job_close(&explorer->check.job);
    }
    free(explorer->check.line);
    for (size_t i = 0; i < GM_TYPED_KINDS; i++) {
        free(explorer->typed_prompt.last[i]);
    }
}
