/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Any text as a system: it is read, with its equations and structure, or refused with a sentence. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "core/model/equations.h"
#include "core/model/facts.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool holds)
{
    if (!holds) {
        abort();
    }
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
    } else if (!large) {
        require(fault.sentence[0] && strlen(fault.sentence) < GM_FAULT_SENTENCE && fault.offset <= size);
    }
    if (!large) {
        gm_system_close(&system);
    }
    free(text);
    return 0;
}
