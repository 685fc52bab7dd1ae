/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Splitting methods for H(q, p) = T(p) + V(q): compositions of the exact flows
       drift   q := q + c h dT/dp(p)
       kick    p := p - c h dV/dq(q)
   Each flow is symplectic, so is every composition. An invariant q' A p of H has
       {q' A p, T} + {q' A p, V} = 0,
   of which the first depends on p alone and the second on q alone: both vanish, and each flow keeps it.
   R.I. McLachlan & G.R.W. Quispel, Acta Numerica 11 (2002) 341; Hairer, Lubich & Wanner (2006), section
   II.5. */
#include "core/ode/families/splitting/splitting.h"

#include <stdlib.h>

#include "core/basics.h"
#include "core/ode/families/families.h"
#include "core/ode/kernel/loops.h"
#include "core/ode/kernel/tiles.h"
#include "core/theory/coefficients.h"

#define DRIFT(c)                                                                                             \
    {                                                                                                        \
        GM_DRIFT, c                                                                                          \
    }
#define KICK(c)                                                                                              \
    {                                                                                                        \
        GM_KICK, c                                                                                           \
    }

static const struct gm_splitting_row symplectic_euler = {.splitting = {2, {KICK(1), DRIFT(1)}}};
static const struct gm_splitting_row symplectic_euler_adjoint = {.splitting = {2, {DRIFT(1), KICK(1)}}};
static const struct gm_splitting_row verlet = {.splitting = {3, {KICK(0.5), DRIFT(1), KICK(0.5)}}};
static const struct gm_splitting_row verlet_position = {.splitting = {3, {DRIFT(0.5), KICK(1), DRIFT(0.5)}}};
static const struct gm_splitting_row ruth3 = {
    .splitting = {6, {DRIFT(1), KICK(-1. / 24), DRIFT(-2. / 3), KICK(3. / 4), DRIFT(2. / 3), KICK(7. / 24)}}};

/* Palindromes, of which half is written down: pieces of one kind on the odd places, of the other on the
   even. */
#define SYMMETRIC_5(ODD, EVEN, a, b) ODD(a), EVEN(b), ODD(1 - 2 * (a)), EVEN(b), ODD(a)
#define SYMMETRIC_9(ODD, EVEN, a, b, c, d, e)                                                                \
    ODD(a), EVEN(b), ODD(c), EVEN(d), ODD(e), EVEN(d), ODD(c), EVEN(b), ODD(a)
#define SYMMETRIC_13(ODD, EVEN, a, b, c, d, e, f, g)                                                         \
    ODD(a), EVEN(b), ODD(c), EVEN(d), ODD(e), EVEN(f), ODD(g), EVEN(f), ODD(e), EVEN(d), ODD(c), EVEN(b),    \
        ODD(a)

static const struct gm_splitting_row mclachlan2 = {
    .splitting = {5, {SYMMETRIC_5(KICK, DRIFT, 0.1931833275037836, 0.5)}}};

#define XI 0.1786178958448091
#define LAMBDA -0.2123418310626054
#define CHI -0.06626458266981849
static const struct gm_splitting_row pefrl4 = {
    .splitting = {9, {SYMMETRIC_9(DRIFT, KICK, XI, 0.5 - LAMBDA, CHI, LAMBDA, 1 - 2 * (CHI + XI))}}};

#define A1 0.0792036964311957
#define A2 0.353172906049774
#define A3 -0.0420650803577195
#define B1 0.209515106613362
#define B2 -0.143851773179818
static const struct gm_splitting_row blanes_moan4 = {
    .splitting = {13,
                  {SYMMETRIC_13(DRIFT, KICK, A1, B1, A2, B2, A3, 0.5 - (B1 + B2), 1 - 2 * (A1 + A2 + A3))}}};
#undef A1
#undef A2
#undef A3
#undef B1
#undef B2

#define A1 0.245298957184271
#define A2 0.604872665711080
#define B1 0.0829844064174052
#define B2 0.396309801498368
#define B3 -0.0390563049223486
static const struct gm_splitting_row blanes_moan_nystrom4 = {
    .splitting = {13,
                  {SYMMETRIC_13(KICK, DRIFT, B1, A1, B2, A2, B3, 0.5 - (A1 + A2), 1 - 2 * (B1 + B2 + B3))}}};
#undef A1
#undef A2
#undef B1
#undef B2
#undef B3

#define A1 0.123229775946271
#define A2 0.290553797799558
#define A3 -0.127049212625417
#define A4 -0.246331761062075
#define A5 0.357208872795928
#define A6 (1 - 2 * (A1 + A2 + A3 + A4 + A5))
#define B1 0.0414649985182624
#define B2 0.198128671918067
#define B3 -0.0400061921041533
#define B4 0.0752539843015807
#define B5 -0.0115113874206879
#define B6 (0.5 - (B1 + B2 + B3 + B4 + B5))
static const struct gm_splitting_row blanes_moan_nystrom6 = {
    .splitting = {23, {KICK(B1), DRIFT(A1), KICK(B2), DRIFT(A2), KICK(B3), DRIFT(A3), KICK(B4), DRIFT(A4),
                       KICK(B5), DRIFT(A5), KICK(B6), DRIFT(A6), KICK(B6), DRIFT(A5), KICK(B5), DRIFT(A4),
                       KICK(B4), DRIFT(A3), KICK(B3), DRIFT(A2), KICK(B2), DRIFT(A1), KICK(B1)}}};

#define SPLITTING .family = &gm_family_splitting, .needs = GM_NEEDS_SPLIT
#define NYSTROM .family = &gm_family_splitting, .needs = GM_NEEDS_SPLIT | GM_NEEDS_NYSTROM
#define SYMPLECTIC (GM_SYMPLECTIC | GM_KEEPS_LINEAR | GM_KEEPS_BILINEAR)
#define SYMMETRIC (SYMPLECTIC | GM_SYMMETRIC | GM_REVERSIBLE)

#define LENGTHS "of lengths γ₁h, …, γ_sh,  γ_{s+1−i} = γᵢ"
#define VERLETS(composition, key, words, degree, lengths, source)                                            \
    {                                                                                                        \
        .name = key, .title = words, .formula = lengths, .reference = source, SPLITTING,                     \
        .coefficients = &(const struct gm_splitting_row){.of_verlet = &gm_composition_##composition},        \
        .order = degree, .claims = SYMMETRIC                                                                 \
    }

static const struct gm_scheme schemes[] = {
    {
        .name = "symplectic-euler",
        .title = "symplectic Euler",
        .formula = "p₁ = p₀ − h ∂H/∂q(q₀),  q₁ = q₀ + h ∂H/∂p(p₁)",
        .reference = "R. de Vogelaere (1956); Razafindralandy et al. (2018), eq. 24",
        .coefficients = &symplectic_euler,
        .order = 1,
        .claims = SYMPLECTIC,
        SPLITTING,
    },
    {
        .name = "symplectic-euler-adjoint",
        .title = "symplectic Euler (adjoint)",
        .formula = "q₁ = q₀ + h ∂H/∂p(p₀),  p₁ = p₀ − h ∂H/∂q(q₁)",
        .reference = "Hairer, Lubich & Wanner (2006), VI.3",
        .coefficients = &symplectic_euler_adjoint,
        .order = 1,
        .claims = SYMPLECTIC,
        SPLITTING,
    },
    {
        .name = "verlet",
        .title = "Verlet",
        .formula = "p½ = p₀ − h/2 ∂V(q₀),  q₁ = q₀ + h ∂T(p½),  p₁ = p½ − h/2 ∂V(q₁)",
        .reference = "L. Verlet, Phys. Rev. 159 (1967) 98; C. Størmer (1907)",
        .coefficients = &verlet,
        .order = 2,
        .claims = SYMMETRIC,
        SPLITTING,
    },
    {
        .name = "verlet-position",
        .title = "Verlet (position)",
        .formula = "q½ = q₀ + h/2 ∂T(p₀),  p₁ = p₀ − h ∂V(q½),  q₁ = q½ + h/2 ∂T(p₁)",
        .reference = "Hairer, Lubich & Wanner (2006), I.1.4",
        .coefficients = &verlet_position,
        .order = 2,
        .claims = SYMMETRIC,
        SPLITTING,
    },
    {
        .name = "mclachlan2",
        .title = "McLachlan 2",
        .formula = "kick λ, drift 1/2, kick 1 − 2λ, drift 1/2, kick λ,  λ = 0.19318…",
        .reference =
            "R.I. McLachlan, SIAM J. Sci. Comput. 16 (1995) 151; Omelyan, Mryglod & Folk, Comput. Phys. Commun. 146 (2002) 188",
        .coefficients = &mclachlan2,
        .order = 2,
        .claims = SYMMETRIC,
        SPLITTING,
    },
    {
        .name = "ruth3",
        .title = "Ruth 3",
        .formula = "drift 1, kick −1/24, drift −2/3, kick 3/4, drift 2/3, kick 7/24",
        .reference = "R.D. Ruth, IEEE Trans. Nucl. Sci. 30 (1983) 2669",
        .coefficients = &ruth3,
        .order = 3,
        .claims = SYMPLECTIC,
        SPLITTING,
    },
    VERLETS(yoshida4, "yoshida4", "Yoshida 4", 4,
            "three Verlet steps of lengths bh, (1 − 2b)h, bh,  b = 1/(2 − ∛2)",
            "E. Forest & R.D. Ruth, Physica D 43 (1990) 105; H. Yoshida, Phys. Lett. A 150 (1990) 262"),
    VERLETS(suzuki4, "suzuki4", "Suzuki 4", 4,
            "five Verlet steps of lengths bh, bh, (1 − 4b)h, bh, bh,  b = 1/(4 − ∛4)",
            "M. Suzuki, Phys. Lett. A 146 (1990) 319"),
    VERLETS(mclachlan4, "mclachlan4", "McLachlan 4", 4,
            "five Verlet steps of lengths γ₁h, γ₂h, γ₃h, γ₂h, γ₁h,  γ₁ = 0.28",
            "R.I. McLachlan, SIAM J. Sci. Comput. 16 (1995) 151"),
    {
        .name = "pefrl4",
        .title = "PEFRL 4",
        .formula = "drift ξ, kick 1/2 − λ, drift χ, kick λ, drift 1 − 2(χ + ξ), and back",
        .reference = "Omelyan, Mryglod & Folk, Comput. Phys. Commun. 146 (2002) 188",
        .coefficients = &pefrl4,
        .order = 4,
        .claims = SYMMETRIC,
        SPLITTING,
    },
    {
        .name = "blanes-moan4",
        .title = "Blanes-Moan 4",
        .formula = "drift a₁, kick b₁, drift a₂, kick b₂, drift a₃, kick b₃, drift a₄, and back",
        .reference = "S. Blanes & P.C. Moan, J. Comput. Appl. Math. 142 (2002) 313, S6 of order 4",
        .coefficients = &blanes_moan4,
        .order = 4,
        .claims = SYMMETRIC,
        SPLITTING,
    },
    {
        .name = "blanes-moan-nystrom4",
        .title = "Blanes-Moan Nyström 4",
        .formula = "kick b₁, drift a₁, kick b₂, drift a₂, kick b₃, drift a₃, kick b₄, and back;  T quadratic",
        .reference =
            "S. Blanes & P.C. Moan, J. Comput. Appl. Math. 142 (2002) 313, Runge-Kutta-Nyström, 6 stages",
        .coefficients = &blanes_moan_nystrom4,
        .order = 4,
        .claims = SYMMETRIC,
        NYSTROM,
    },
    VERLETS(yoshida6, "yoshida6", "Yoshida 6", 6, "seven Verlet steps " LENGTHS,
            "H. Yoshida, Phys. Lett. A 150 (1990) 262, solution A"),
    VERLETS(kahan_li6, "kahan-li6", "Kahan-Li 6", 6, "nine Verlet steps " LENGTHS,
            "W. Kahan & R.-C. Li, Math. Comp. 66 (1997) 1089"),
    {
        .name = "blanes-moan-nystrom6",
        .title = "Blanes-Moan Nyström 6",
        .formula = "kick b₁, drift a₁, …, kick b₆, drift a₆, and back;  T quadratic",
        .reference =
            "S. Blanes & P.C. Moan, J. Comput. Appl. Math. 142 (2002) 313, Runge-Kutta-Nyström, 11 stages",
        .coefficients = &blanes_moan_nystrom6,
        .order = 6,
        .claims = SYMMETRIC,
        NYSTROM,
    },
    VERLETS(suzuki_umeno8, "suzuki-umeno8", "Suzuki-Umeno 8", 8, "fifteen Verlet steps " LENGTHS,
            "M. Suzuki & K. Umeno, in: Computer Simulation Studies in Condensed-Matter Physics VI (1993) 74; "
            "Hairer, Lubich & Wanner (2006), section V.3.2"),
    VERLETS(kahan_li8, "kahan-li8", "Kahan-Li 8", 8, "seventeen Verlet steps " LENGTHS,
            "W. Kahan & R.-C. Li, Math. Comp. 66 (1997) 1089"),
};

/* Each piece is a stage, which knows those before it. A first force is the last one of the step before. */
static bool coefficients_open(const struct gm_scheme *scheme, struct gm_coefficients *coefficients)
{
    struct gm_splitting made;
    const struct gm_splitting *splitting = gm_splitting_of(scheme->coefficients, &made);
    const int stages = splitting->count;
    if (!gm_coefficients_open(
            coefficients, scheme->needs & GM_NEEDS_NYSTROM ? GM_EQUATIONS_NYSTROM : GM_EQUATIONS_SEPARABLE,
            stages)) {
        return false;
    }
    coefficients->evaluations = 0;
    for (int j = 0; j < stages; j++) {
        const bool kick = splitting->pieces[j].piece == GM_KICK;
        const int side = kick ? GM_SIDE_P : GM_SIDE_Q;
        const struct gm_ball fraction = gm_ball_written(splitting->pieces[j].fraction);
        const bool reused = kick && j == stages - 1 && splitting->pieces[0].piece == GM_KICK;
        coefficients->evaluations += kick && !reused ? 1 : 0;
        coefficients->b[side][j] = fraction;
        for (int i = j + 1; i < stages; i++) {
            coefficients->a[side][i * stages + j] = fraction;
        }
    }
    return true;
}

/* The loop where n is chosen at run time, as that over kernels: the force is kept from the last kick of a
   step to the first of the next. A last component that is the time moves with q. */
GM_OF_TILE enum gm_status step_of(const struct gm_task *task, struct gm_tile *tile,
                                  struct gm_progress *progress, size_t members)
{
    const struct gm_problem *problem = task->problem;
    const struct gm_splitting *table = tile->row;
    const size_t half = problem->n / 2 * members;
    const bool ends_with_kick = table->pieces[table->count - 1].piece == GM_KICK;
    const double *velocity = gm_ode_of(problem)->split->unit_mass ? tile->y + half : tile->scratch;
    double *force = tile->scratch + half;
    for (int i = 0; i < table->count; i++) {
        const double c = table->pieces[i].fraction * task->dt;
        if (table->pieces[i].piece == GM_DRIFT) {
            if (velocity == tile->scratch) {
                tile->loops->velocity(problem, tile->y, tile->scratch, members);
            }
            gm_tile_add(tile->y, c, velocity, tile->carry, half);
            if (problem->n % 2 != 0) {
                static const double one = 1;
                for (size_t l = 2 * half; l < 2 * half + members; l++) {
                    gm_tile_add(tile->y + l, c, &one, tile->carry ? tile->carry + l : NULL, 1);
                }
            }
            tile->known = false;
            continue;
        }
        if (!tile->known) {
            tile->loops->force(problem, tile->y, force, members);
            tile->known = true;
            const bool counted = i == 0 && ends_with_kick && task->steps_before > 0;
            progress->evaluations += counted ? 0 : members;
        }
        gm_tile_add(tile->y + half, c, force, tile->carry ? tile->carry + half : NULL, half);
    }
    return GM_OK;
}

GM_STEPS_OF_TILE(step_of)

static struct gm_progress advance(const struct gm_task *task)
{
    struct gm_splitting made;
    const struct gm_splitting *table = gm_splitting_of(task->scheme->coefficients, &made);
    return gm_tiles_advance(task, table, task->problem->m == 1 ? step_one : step_many);
}

static void *workspace_open(const struct gm_problem *problem, const struct gm_scheme *scheme)
{
    (void)scheme;
    return gm_tiles_open(problem, problem->n, 0);
}

const struct gm_family gm_family_splitting = {
    .kind = &gm_kind_ode,
    .over_kernels = GM_OVER_SPLITTING,
    .coefficients_open = coefficients_open,
    .title = "splitting",
    .schemes = schemes,
    .count = GM_COUNT(schemes),
    .parameters = gm_settings_of_sums,
    .loop = advance,
    .workspace_open = workspace_open,
    .workspace_close = free,
};
