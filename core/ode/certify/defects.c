/* SPDX-License-Identifier: GPL-3.0-or-later */
/* What of the geometry a scheme breaks in a step or a short run: the defects of symplecticity, volume,
   symmetry, reversibility, energy and other invariants. The derivative of a step is found by extrapolated
   differences between members of an ensemble, so it asks nothing of the scheme. */
#include <math.h>
#include <string.h>

#include "core/ode/certify/measure.h"
#include "core/ode/families/members.h"
#include "core/run.h"

enum { MOST = 2 * GM_SUBJECT_COMPONENTS, LEVELS = 4 };

/* The derivative of one step at the start. */
static bool differentiate(const struct gm_subject *subject, const struct gm_scheme *scheme,
                          double tangent[MOST][MOST])
{
    const size_t n = gm_subject_components(subject, scheme), members = n * LEVELS * 2;
    double from[MOST], start[MOST * MOST * LEVELS * 2], end[MOST * MOST * LEVELS * 2];
    const double widest = 0.02;
    gm_subject_start(subject, scheme, from);
    for (size_t column = 0; column < n; column++) {
        for (size_t level = 0; level < LEVELS; level++) {
            for (size_t side = 0; side < 2; side++) {
                const size_t member = (column * LEVELS + level) * 2 + side;
                for (size_t c = 0; c < n; c++) {
                    const double shift = c == column ? ldexp(widest, -(int)level) : 0;
                    start[c * members + member] = from[c] + (side ? -shift : shift);
                }
            }
        }
    }
    if (!gm_subject_advance(subject, scheme, subject->dt, 1, members, start, end)) {
        return false;
    }
    for (size_t row = 0; row < n; row++) {
        for (size_t column = 0; column < n; column++) {
            double table[LEVELS];
            for (size_t level = 0; level < LEVELS; level++) {
                const size_t at = row * members + (column * LEVELS + level) * 2;
                const size_t below = column * members + (column * LEVELS + level) * 2;
                table[level] = (end[at] - end[at + 1]) / (start[below] - start[below + 1]);
            }
            double power = 4;
            for (size_t done = 1; done < LEVELS; done++, power *= 4) {
                for (size_t level = LEVELS - 1; level >= done; level--) {
                    table[level] += (table[level] - table[level - 1]) / (power - 1);
                }
            }
            tangent[row][column] = table[LEVELS - 1];
        }
    }
    return true;
}

double gm_symplecticity_defect(const struct gm_subject *subject, const struct gm_scheme *scheme)
{
    double tangent[MOST][MOST];
    if (!differentiate(subject, scheme, tangent)) {
        return INFINITY;
    }
    const size_t all = gm_subject_components(subject, scheme), n = subject->problem.n, half = n / 2;
    double defect = 0;
    for (size_t a = 0; a < all; a++) {
        for (size_t b = 0; b < all; b++) {
            double form = b == a + half && a % n < half ? -1 : a == b + half && b % n < half ? 1 : 0;
            for (size_t copy = 0; copy < all; copy += n) {
                for (size_t q = copy; q < copy + half; q++) {
                    form += tangent[q][a] * tangent[q + half][b] - tangent[q + half][a] * tangent[q][b];
                }
            }
            defect = fmax(defect, fabs(form));
        }
    }
    return defect;
}

double gm_volume_defect(const struct gm_subject *subject, const struct gm_scheme *scheme)
{
    double tangent[MOST][MOST];
    if (subject->problem.n != 3 || !differentiate(subject, scheme, tangent)) {
        return INFINITY;
    }
    double determinant = 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        determinant += tangent[0][i] * (tangent[1][j] * tangent[2][k] - tangent[1][k] * tangent[2][j]);
    }
    return fabs(determinant - 1);
}

/* How far a run that turns round ends from its start. Where the scheme chooses its steps, a few of them, so
   that it has chosen some. */
static double return_defect(const struct gm_subject *subject, const struct gm_scheme *scheme, bool reflected)
{
    const bool own_time = scheme->family->own_time;
    double start[MOST], back[MOST];
    gm_subject_start(subject, scheme, start);
    if (!gm_subject_turn(subject, scheme, own_time ? subject->dt / 4 : subject->dt, own_time ? 3 : 1,
                         reflected, back)) {
        return INFINITY;
    }
    return gm_distance(back, start, gm_subject_components(subject, scheme));
}

double gm_symmetry_defect(const struct gm_subject *subject, const struct gm_scheme *scheme)
{
    return return_defect(subject, scheme, false);
}

double gm_reversibility_defect(const struct gm_subject *subject, const struct gm_scheme *scheme)
{
    return return_defect(subject, scheme, true);
}

double gm_drift(const struct gm_subject *subject, const struct gm_scheme *scheme,
                gm_invariant *const *quantities, size_t count)
{
    /* A scheme that chooses its step may end for want of one: what it has done counts. */
    const bool own_time = scheme->family->own_time;
    const double dt = own_time ? subject->dt / 200 : subject->dt / 12;
    double whole[MOST], end[MOST], largest = 0;
    gm_subject_start(subject, scheme, whole);
    if (!gm_subject_advance(subject, scheme, dt, own_time ? 1000 : 100, 1, whole, end) && !own_time) {
        return INFINITY;
    }
    for (size_t i = 0; i < count && quantities[i]; i++) {
        const double before = quantities[i](&subject->problem, subject->start);
        const double after = quantities[i](&subject->problem, end);
        largest = fmax(largest, fabs(after - before) / fmax(1, fabs(before)));
    }
    return largest;
}

double gm_energy_drift(const struct gm_subject *subject, const struct gm_scheme *scheme)
{
    static gm_invariant *const energies[] = {gm_energy};
    return gm_drift(subject, scheme, energies, 1);
}
