/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Any text as a system: it is read, with its equations and structure, or refused with a sentence. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "core/mesh/user/potential.h"
#include "core/model/equations.h"
#include "core/model/facts.h"
#include "core/user/line.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool holds)
{
    if (!holds) {
        abort();
    }
}

/* The lines of a moving mesh: a problem whose start is sound, or a sentence. */
static void place_mesh(struct gm_user_system *system)
{
    struct gm_user_wave wave;
    struct gm_problem problem;
    double *values = gm_equations_start(system, NULL);
    char *const *texts = system->texts;
    const struct gm_user_mesh chosen = {
        .first = -6,
        .length = 12,
        .points = 5,
        .alpha = NAN,
        .until = 1,
        .density = texts[GM_WORD_DENSITY] ? texts[GM_WORD_DENSITY] : "1",
        .map = texts[GM_WORD_MESH],
        .cell = texts[GM_WORD_CELL],
        .nodes = texts[GM_WORD_NODES],
        .between = texts[GM_WORD_BETWEEN],
    };
    if (values && gm_user_wave_derive(&wave, system)) {
        struct gm_fault fault = {0};
        require(gm_user_mesh_open(&problem, &wave, values, &chosen));
        require(gm_user_mesh_rests(&problem, &fault) || fault.sentence[0]);
        gm_user_line_close(&problem);
    }
    free(values);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct gm_user_system system;
    struct gm_fault fault;
    struct gm_finding findings[GM_FACTS];
    char *text = malloc(size + 1);
    require(text != NULL);
    memcpy(text, data, size);
    text[size] = '\0';
    /* large lists and loops are slow, not wrong */
    bool large = false;
    for (size_t i = 0, digits = 0; i < size; i++) {
        digits = text[i] >= '0' && text[i] <= '9' ? digits + 1 : 0;
        large |= digits > 2;
    }
    if (!large && gm_equations_open(&system, text, size, NULL, 0, &fault)) {
        require(gm_facts_find(&system, findings));
        for (enum gm_fact fact = 0; fact < GM_FACTS; fact++) {
            char *reason = findings[fact].asked ? gm_fact_reason(&system, fact, &findings[fact]) : NULL;
            require(!findings[fact].asked || reason);
            free(reason);
        }
        const struct gm_naming naming = gm_system_naming(&system);
        for (size_t i = 0; i < system.n; i++) {
            if (system.rates[i] != GM_NO_NODE) {
                free(gm_formula_text(&system.graph, system.rates[i], &naming));
                free(gm_formula_latex(&system.graph, system.rates[i], &naming));
            }
        }
        if (system.kind == GM_FIELD) {
            place_mesh(&system);
        }
    } else if (!large) {
        require(fault.sentence[0] && strlen(fault.sentence) < GM_FAULT_SENTENCE && fault.offset <= size);
    }
    if (!large) {
        gm_system_close(&system);
    }
    free(text);
    return 0;
}
