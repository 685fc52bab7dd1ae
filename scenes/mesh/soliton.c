/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Solitons between walls on linear elements whose nodes follow them: r-adaptive variational integrators.
   Tyranowski & Desbrun (2019), section 5, figures 2 to 14. */
#include "scenes/mesh/soliton_draw.h"

#include <math.h>
#include <stdio.h>

enum { PATHS = 255 /* most nodes whose paths are recorded */, RECORDS = 400 };

static const char *const fields[] = {"sine-gordon", "phi4", NULL};
static const char *const densities[] = {"arclength", "curvature", "mix", "limited", "tempered", NULL};
static const char *const shows[] = {"all", "field", "mesh", "energy", "convergence", NULL};

static const struct gm_parameter parameters[] = {
    GM_DT("0.01", 1e-6, 10),
    GM_UNTIL("50"),
    {
        .key = "solitons",
        .unit = "",
        .help = "one soliton, or two that bounce off each other",
        .type = GM_INTEGER,
        .offset = offsetof(struct gm_soliton_scene, own.solitons),
        .standard = "1",
        .lowest = 1,
        .highest = 2,
    },
    {
        .key = "points",
        .unit = "",
        .help = "nodes between the ends",
        .type = GM_INTEGER,
        .offset = offsetof(struct gm_soliton_scene, own.points),
        .standard = "31",
        .lowest = 1,
        .highest = 1e5,
        .logarithmic = true,
    },
    {
        .key = "velocity",
        .unit = "",
        .help = "of the solitons; 1 is that of light",
        .type = GM_REAL,
        .offset = offsetof(struct gm_soliton_scene, own.velocity),
        .standard = "0.9",
        .lowest = 0.01,
        .highest = 0.999999,
    },
    {
        .key = "alpha",
        .unit = "",
        .help = "weight of the field's slope in the mesh density; auto: 2.5 for one soliton, 1.5 for two",
        .type = GM_REAL,
        .offset = offsetof(struct gm_soliton_scene, own.alpha),
        .standard = "auto",
        .lowest = 0,
        .highest = 1000,
        .automatic = true,
    },
    {
        .key = "density",
        .unit = "",
        .help =
            "what the nodes equidistribute: arclength, curvature, a mix of both, or arclength that is limited or "
            "tempered where the field is steeper than a soliton",
        .type = GM_CHOICE,
        .offset = offsetof(struct gm_soliton_scene, own.density),
        .standard = "arclength",
        .choices = densities,
    },
    {
        .key = "potential",
        .unit = "",
        .help = "W(φ) = 1 − cos φ or (φ² − 1)²/4",
        .type = GM_CHOICE,
        .offset = offsetof(struct gm_soliton_scene, own.field),
        .standard = "sine-gordon",
        .choices = fields,
    },
    {
        .key = "length",
        .unit = "",
        .help = "distance of the walls",
        .type = GM_REAL,
        .offset = offsetof(struct gm_soliton_scene, own.length),
        .standard = "25",
        .lowest = 1,
        .highest = 1e4,
        .logarithmic = true,
    },
    {
        .key = "show",
        .unit = "",
        .help =
            "what the picture shows: all, the field, the paths of the nodes, the energy, or error over nodes",
        .type = GM_CHOICE,
        .offset = offsetof(struct gm_soliton_scene, show),
        .standard = "all",
        .choices = shows,
        .live = true,
    },
};

static void resolve(void *own)
{
    struct gm_soliton_scene *soliton = own;
    soliton->own.alpha = gm_soliton_alpha(&soliton->own);
}

static bool setup(const void *own, struct gm_problem *problem, char *sentence)
{
    (void)sentence;
    const struct gm_soliton_scene *soliton = own;
    gm_soliton_problem(&soliton->own, problem);
    return true;
}

static bool start_with(const void *own, const struct gm_problem *problem, const struct gm_scheme *scheme,
                       double *y, char *sentence)
{
    const struct gm_soliton_scene *soliton = own;
    struct gm_mesh mesh;
    gm_moving_mesh_of(problem)->describe(problem, &mesh);
    if (gm_mesh_start(&mesh, gm_scheme_mesh(scheme), gm_soliton_profile, &soliton->own, y)) {
        return true;
    }
    double wall, slope, rate;
    gm_soliton_profile(&soliton->own, 0, &wall, &slope, &rate);
    if (fabs(wall - mesh.left) > 0.01) {
        /* a jump at the wall, which no cell can be small enough for */
        snprintf(
            sentence, GM_SENTENCE,
            "no mesh was found: a box of length %g cuts the soliton off, which at velocity = %g is wider",
            soliton->own.length, soliton->own.velocity);
        return false;
    }
    snprintf(sentence, GM_SENTENCE,
             "no mesh of %ld nodes was found for alpha = %g and velocity = %g: the homotopy from the uniform "
             "mesh fails; a smaller alpha helps",
             soliton->own.points, gm_soliton_alpha(&soliton->own), soliton->own.velocity);
    return false;
}

static bool moves(const struct gm_view *view)
{
    return gm_scheme_mesh(view->run->scheme) == GM_MESH_MOVING;
}

static double solution_error(const struct gm_view *view)
{
    const struct gm_soliton_scene *soliton = view->parameters;
    const size_t points = (size_t)soliton->own.points;
    double largest = 0;
    for (size_t k = 0; k < points; k++) {
        const double difference =
            fabs(view->state[k] - gm_soliton_exact(&soliton->own, view->state[points + k], view->t));
        largest = difference <= largest ? largest : difference;
    }
    return largest;
}

/* The time by which the exact solution has to be shifted to fit the nodes best (least squares, by Gauss and
   Newton's iteration): positive where the numerical one is ahead. At a bounce, where the field stands still,
   it cannot be told: NaN where none below 1 is found, and where no exact solution is known. */
static double lead(const struct gm_view *view)
{
    enum { MOST_ITERATIONS = 6 };
    const double near = 1e-5, close_enough = 1e-4;
    const struct gm_soliton_scene *soliton = view->parameters;
    const size_t points = (size_t)soliton->own.points;
    double shift = 0;
    for (int i = 0; i < MOST_ITERATIONS; i++) {
        double sum = 0, weight = 0;
        for (size_t k = 0; k < points; k++) {
            const double x = view->state[points + k], t = view->t + shift;
            const double exact = gm_soliton_exact(&soliton->own, x, t);
            const double rate = (gm_soliton_exact(&soliton->own, x, t + near) - exact) / near;
            sum += (view->state[k] - exact) * rate;
            weight += rate * rate;
        }
        shift += sum / weight;
        if (!(fabs(sum / weight) > close_enough)) {
            break;
        }
    }
    return fabs(shift) < 1 ? shift : NAN;
}

/* Where the first soliton is: where the field, linear between the nodes, is half of its height, π. NaN where
   it is not, or has no such height (phi^4). */
static double position(const struct gm_view *view)
{
    const struct gm_soliton_scene *soliton = view->parameters;
    const size_t points = (size_t)soliton->own.points;
    const double *field = view->state, *place = field + points;
    for (size_t k = 1; k < points && soliton->own.field == GM_SINE_GORDON; k++) {
        const double before = field[k - 1] - M_PI, after = field[k] - M_PI;
        if (before * after <= 0 && before != after) {
            return place[k - 1] + (place[k] - place[k - 1]) * before / (before - after);
        }
    }
    return NAN;
}

static double energy(const struct gm_view *view)
{
    const struct gm_mesh mesh = gm_soliton_mesh(view);
    return gm_mesh_energy(&mesh, view->state);
}

static double energy_continuum_error(const struct gm_view *view)
{
    const struct gm_soliton_scene *soliton = view->parameters;
    const double continuum = gm_soliton_energy(&soliton->own);
    return fabs(energy(view) - continuum) / continuum;
}

static double constraint_defect(const struct gm_view *view)
{
    const struct gm_mesh mesh = gm_soliton_mesh(view);
    return moves(view) ? gm_mesh_constraint_defect(&mesh, view->state) : NAN;
}

static double multiplier_norm(const struct gm_view *view)
{
    return gm_mesh_multiplier_norm(view->run);
}

static double smallest_cell(const struct gm_view *view)
{
    const struct gm_mesh mesh = gm_soliton_mesh(view);
    return gm_mesh_smallest_cell(&mesh, view->state);
}

static double newton_iterations(const struct gm_view *view)
{
    return (double)view->run->iterations;
}

static double factorisations(const struct gm_view *view)
{
    return gm_mesh_factorisations(view->run);
}

static const struct gm_observable observables[] = {
    [GM_SOLITON_ERROR] = {.key = "solution_error",
                          .title = "error  max |φ − exact| at the nodes",
                          .unit = "",
                          .evaluate = solution_error,
                          .logarithmic = true},
    {.key = "lead",
     .title = "time ahead of the exact solution",
     .missing = "no shift in time brings the exact solution near",
     .unit = "",
     .evaluate = lead},
    {.key = "position",
     .title = "place of the soliton, φ = π",
     .missing = "the field is nowhere π",
     .unit = "",
     .evaluate = position},
    {.key = "energy", .title = "discrete energy", .unit = "", .evaluate = energy},
    {.key = "energy_error",
     .title = "energy error",
     .unit = "",
     .evaluate = energy,
     .error = true,
     .symbol = "E",
     .kept = true,
     .logarithmic = true},
    {.key = "energy_continuum_error",
     .title = "difference from the solitons' energy",
     .unit = "",
     .evaluate = energy_continuum_error,
     .logarithmic = true},
    {.key = "constraint_defect",
     .title = "defect of the mesh constraint",
     .missing = "this mesh does not move",
     .unit = "",
     .evaluate = constraint_defect,
     .logarithmic = true},
    {.key = "multiplier_norm", .title = "largest multiplier", .unit = "", .evaluate = multiplier_norm},
    {.key = "smallest_cell",
     .title = "smallest cell",
     .unit = "",
     .evaluate = smallest_cell,
     .logarithmic = true},
    {.key = "newton_iterations", .title = "Newton iterations", .unit = "", .evaluate = newton_iterations},
    {.key = "factorisations", .title = "matrices factored", .unit = "", .evaluate = factorisations},
};

/* Paths of all nodes, or of evenly chosen ones. */
static size_t path_stride(size_t points)
{
    return (points + PATHS - 1) / PATHS;
}

static size_t path_count(const struct gm_view *view)
{
    const size_t points = view->problem->n / 4, stride = path_stride(points);
    return (points + stride - 1) / stride;
}

static double path_interval(const void *own)
{
    return ((const struct gm_timing *)own)->until / (RECORDS / 2 - 1);
}

static void record_paths(const struct gm_view *view, double *entry)
{
    const size_t points = view->problem->n / 4, stride = path_stride(points);
    for (size_t k = 0; k < points; k += stride) {
        *entry++ = view->state[points + k];
    }
}

static const struct gm_track tracks[] = {
    [GM_SOLITON_PATHS] = {.key = "paths",
                          .width = path_count,
                          .interval = path_interval,
                          .bound = RECORDS,
                          .record = record_paths},
};

static const char *const schemes[] = {"multiplier-lobatto4", "control-gauss4",         "uniform-gauss4",
                                      "multiplier-lobatto2", "multiplier-trapezoidal", "multiplier-adaptive4",
                                      "control-gauss2",      "control-lobatto2",       "control-lobatto4",
                                      "control-radau3",      "control-radau5",         "uniform-gauss2",
                                      "uniform-lobatto2",    "uniform-lobatto4",       NULL};

static const struct gm_figure figures[] = {
    {
        .name = "tyranowski-2",
        .statement = "the single soliton of the sine-Gordon equation",
        .arguments = "scheme=multiplier-lobatto4 points=63 until=0 show=field",
    },
    {
        .name = "tyranowski-3",
        .statement = "the two-soliton solution",
        .arguments = "scheme=multiplier-lobatto4 solitons=2 points=63 until=0 show=field",
    },
    {
        .name = "tyranowski-4",
        .statement =
            "17 mesh points capture the soliton with the multiplier strategy; it bounces at 13.84 and 41.52",
        .arguments = "scheme=multiplier-lobatto4 points=15 until=50",
    },
    {
        .name = "tyranowski-5",
        .statement = "the multiplier strategy with 31 nodes",
        .arguments = "scheme=multiplier-lobatto4 points=31 until=50",
    },
    {
        .name = "tyranowski-6",
        .statement = "the control-theoretic strategy with 22 nodes",
        .arguments = "scheme=control-gauss4,control-lobatto4 points=22 until=50",
    },
    {
        .name = "tyranowski-7",
        .statement = "the control-theoretic strategy with 31 nodes",
        .arguments = "scheme=control-gauss4,control-lobatto4 points=31 until=50",
    },
    {
        .name = "tyranowski-8",
        .statement = "mesh points of the multiplier strategy, 22 and 31 of them",
        .arguments = "points=22,31 scheme=multiplier-lobatto4 until=50 show=mesh",
    },
    {
        .name = "tyranowski-9",
        .statement = "mesh points of the control-theoretic strategy, 22 and 31 of them",
        .arguments = "points=22,31 scheme=control-gauss4 until=50 show=mesh",
    },
    {
        .name = "tyranowski-10",
        .statement = "31 nodes that stand still do not resolve the soliton",
        .arguments = "scheme=uniform-gauss4 points=31 until=50",
    },
    {
        .name = "tyranowski-11",
        .statement =
            "the multiplier strategy is more accurate than the control-theoretic one, and both than a uniform mesh",
        .arguments = "scheme=multiplier-lobatto4,control-gauss4,uniform-gauss4 points=15,31,63,127 until=50 "
                     "show=convergence",
    },
    {
        .name = "tyranowski-11-uniform",
        .statement = "on a uniform mesh the error falls quadratically, once there are enough points",
        .arguments = "scheme=uniform-gauss4 points=15,31,63,127,255,361 until=50 show=convergence",
    },
    {
        .name = "tyranowski-12",
        .statement =
            "the multiplier solution gets ahead of the exact one, the control-theoretic solution lags behind",
        .arguments =
            "scheme=multiplier-lobatto4,control-gauss4 solitons=2 points=25 alpha=1.5 dt=0.05 until=100 "
            "show=field",
    },
    {
        .name = "tyranowski-12-breakdown",
        .statement =
            "the multiplier strategy breaks down at about 600, the control-theoretic one beyond 1000",
        .arguments =
            "scheme=multiplier-lobatto2,multiplier-lobatto4,control-gauss4,control-lobatto4,control-radau5 "
            "solitons=2 points=25 alpha=1.5 dt=0.05 until=1100 show=mesh",
    },
    {
        .name = "tyranowski-13",
        .statement =
            "the multiplier strategy keeps the energy, but for spikes at the bounces; order 4 better than 2",
        .arguments = "scheme=multiplier-lobatto2,multiplier-lobatto4 solitons=2 points=25 alpha=1.5 dt=0.05 "
                     "until=300 show=energy",
    },
    {
        .name = "tyranowski-14",
        .statement = "with the control-theoretic strategy the energy wanders, symplectic or not",
        .arguments =
            "scheme=control-gauss4,control-lobatto4,control-radau5 solitons=2 points=25 alpha=1.5 dt=0.05 "
            "until=300 show=energy",
    },
};

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/* Which nodes and which step a scheme does best with is its own affair: each is tried with all. */
static const double resolutions[] = {7, 15, 31, 63, 127, 255, 511, 1023};
static const double compared[] = {1, 0.1, 0.01};

static const struct gm_work work = {
    .arguments = "until=20",
    .measure = "solution_error",
    .coarsest = 0.32,
    .halvings = 6,
    .resolution = "points",
    .resolutions = resolutions,
    .resolution_count = COUNT(resolutions),
    .errors = compared,
};

static double one(const void *own)
{
    (void)own;
    return 1;
}

static const double velocities[] = {0.2, 0.4, 0.6, 0.8, 0.9, 0.98};
static const double steps[] = {0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1};
static const char *const mapped[] = {"multiplier-lobatto4", "multiplier-trapezoidal", "control-gauss4",
                                     "uniform-gauss4", NULL};

static const struct gm_stability stability = {
    .arguments = "until=20",
    .parameter = "velocity",
    .values = velocities,
    .value_count = COUNT(velocities),
    .label = "Δt",
    .unit = one,
    .steps = steps,
    .step_count = COUNT(steps),
    .kept = "energy",
    .error = "solution_error",
    .schemes = mapped,
};

const struct gm_scene gm_scene_soliton = {
    .name = "soliton",
    .title = "Mesh points that follow a soliton",
    .blurb =
        "The sine-Gordon equation between two walls, on linear elements whose nodes move so that the arclength "
        "of the field is equidistributed, with variational integrators for field and mesh.",
    .watch =
        "Watch the energy: the multiplier strategy keeps it, with the control-theoretic one it wanders, although "
        "both meshes follow the soliton equally well.",
    .time = "what light needs for a length of 1",
    .size = sizeof(struct gm_soliton_scene),
    .parameters = parameters,
    .parameter_count = COUNT(parameters),
    .schemes = schemes,
    .observables = observables,
    .observable_count = COUNT(observables),
    .tracks = tracks,
    .track_count = COUNT(tracks),
    .figures = figures,
    .figure_count = COUNT(figures),
    .work = &work,
    .stability = &stability,
    .resolve = resolve,
    .setup = setup,
    .start_with = start_with,
    .draw = gm_soliton_draw,
};
