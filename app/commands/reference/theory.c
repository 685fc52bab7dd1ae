/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Theory in words, for certificates and for the documentation of the schemes. */
#include "app/commands/reference/theory.h"

#include <math.h>
#include <stdio.h>

#include "app/output/json.h"
#include "core/expression/number.h"

static void print_order(const struct gm_theory *theory)
{
    printf("order %d%s", theory->order, theory->at_least ? " at least" : "");
    if (theory->digits > 0) {
        printf(", to the %d digit%s written", theory->digits, gm_plural(theory->digits));
    }
    printf(": %d condition%s", theory->conditions, theory->conditions == 1 ? " holds" : "s hold");
    if (theory->failing > 0) {
        printf("; of order %d, %d of %d fail, most that of %s, by %.1e; error constant %.3g",
               theory->order + 1, theory->failing, theory->of, theory->condition, fabs(theory->residual),
               theory->error_constant);
    } else if (theory->at_most == theory->order) {
        printf("; by B, C and D no further one is asked for; %s fails, by %.1e", theory->condition,
               fabs(theory->residual));
    }
}

static void print_structure(const struct gm_theory *theory)
{
    if (theory->symplectic) {
        printf("symplectic");
    } else if (theory->pseudo_symplectic > theory->order) {
        printf("symplectic up to dt^%d", theory->pseudo_symplectic);
    } else {
        printf("not symplectic");
    }
    printf(", %ssymmetric", theory->symmetric ? "" : "not ");
    if (theory->b > 0) {
        printf("; B(%d), C(%d), D(%d)", theory->b, theory->c, theory->d);
    }
}

static void print_stability(const struct gm_theory_stability *stability)
{
    if (stability->oscillator && isinf(stability->imaginary)) {
        printf("stable on every oscillator");
    } else if (stability->oscillator) {
        printf("stable on the oscillator up to ω dt = %.6g", stability->imaginary);
    } else if (stability->a_stable) {
        printf("%s", stability->l_stable ? "A-stable and L-stable" : "A-stable, not L-stable");
    } else {
        const double bounds[] = {stability->real, stability->imaginary};
        static const char *const axes[] = {"negative", "imaginary"};
        for (int i = 0; i < 2; i++) {
            printf("%s", i == 0 ? "stable on the " : ", on the ");
            if (bounds[i] == 0) {
                printf("%s axis nowhere", axes[i]);
            } else if (isinf(bounds[i])) {
                printf("whole %s axis", axes[i]);
            } else {
                printf("%s axis up to %.6g", axes[i], bounds[i]);
            }
        }
    }
}

void gm_theory_print(const struct gm_theory *theory, const char *indent)
{
    if (!theory->known) {
        return;
    }
    printf("%s", indent);
    print_order(theory);
    printf(";\n%s", indent);
    print_structure(theory);
    if (theory->stability.known) {
        printf(";\n%s", indent);
        print_stability(&theory->stability);
    }
}
