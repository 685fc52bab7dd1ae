/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The meshes of rooms from parameters: they are made or read, and faults explained in a sentence. */
#include "scenes/flow/room_scene.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/files/files.h"
#include "render/files/regular_file.h"

const char *const gm_flows_outlets[] = {"soft", "dirichlet", "free", NULL};
const char *const gm_flows_stars[] = {"auto", "circumcentric", "barycentric", "galerkin", NULL};

static void explain(const char *name, const struct gm_triangulation_fault *fault, char *sentence)
{
    char text[GM_TRIANGULATION_SENTENCE];
    gm_refuse(sentence, "%s", gm_triangulation_explain(name, fault, text));
}

/* Returns the mesh of a rectangle; `strips` 0: the best number. NULL with a sentence on failure. */
static struct gm_complex *lay_rectangle(struct gm_rectangle *rectangle, char *sentence)
{
    enum { MOST = 10000000 };
    const long best =
        gm_rectangle_strips(rectangle->width, rectangle->height, rectangle->edges, rectangle->transposed);
    rectangle->strips = rectangle->strips == 0 ? best : rectangle->strips;
    if ((double)rectangle->edges * (double)rectangle->strips > MOST) {
        gm_refuse(sentence, "%ld edges and %ld strips make more than %d triangles", rectangle->edges,
                  rectangle->strips, 2 * MOST);
        return NULL;
    }
    if (rectangle->strips % 2 != 0) {
        gm_refuse(sentence, "the number of strips of triangles must be even; %ld is a good one", best);
        return NULL;
    }
    if (!gm_rectangle_is_acute(rectangle)) {
        gm_refuse(
            sentence,
            "%ld edges and %ld strips do not make acute triangles: the height of a strip must lie between half an "
            "edge and an edge; %ld strips are best",
            rectangle->edges, rectangle->strips, best);
        return NULL;
    }
    struct gm_triangulation_fault fault;
    struct gm_complex *complex = gm_rectangle_open(rectangle, &fault);
    if (!complex) {
        explain("the mesh", &fault, sentence);
    }
    return complex;
}

/* Reads the mesh of a file, or a built-in one if `inside` is not NULL. */
static bool read_file(const char *path, const struct gm_built_in *inside, enum gm_star star,
                      struct gm_triangulation *mesh, char *sentence)
{
    enum { LARGEST = 1 << 29 };
    size_t size = 0;
    char reason[GM_REGULAR_REASON];
    char *text = inside ? NULL : gm_regular_read(path, LARGEST, &size, reason);
    if (!text && !inside) {
        return gm_refuse(sentence, "%.130s could not be read: %s", path, reason);
    }
    struct gm_triangulation_fault fault;
    const bool good = gm_triangulation_read(inside ? inside->text : text, inside ? inside->length : size,
                                            star, mesh, &fault);
    free(text);
    if (!good) {
        explain(path, &fault, sentence);
    }
    return good;
}

/* Cuts each edge of the mesh of a file into `parts`, a power of two. */
static bool refine(const char *path, enum gm_star star, long parts, struct gm_triangulation *mesh,
                   char *sentence)
{
    enum { MOST_TRIANGLES = 5000000 };
    struct gm_triangulation_fault fault;
    if ((parts & (parts - 1)) != 0) {
        return gm_refuse(sentence, "refine=%ld: edges are halved, and halved again: 1, 2, 4 ...", parts);
    }
    if ((double)mesh->complex->triangles * (double)parts * (double)parts > MOST_TRIANGLES) {
        return gm_refuse(sentence, "refine=%ld makes more than %d triangles of the %zu of %.100s", parts,
                         MOST_TRIANGLES, mesh->complex->triangles, path);
    }
    for (; parts > 1; parts /= 2) {
        if (!gm_triangulation_halve(mesh, star, &fault)) {
            explain(path, &fault, sentence);
            return false;
        }
    }
    return true;
}

bool gm_flows_has_rectangle(const struct gm_flows *flows)
{
    return flows->room->room.rectangular && strcmp(flows->mesh, "none") == 0;
}

bool gm_flows_mesh(const struct gm_flows *flows, const struct gm_room *room, struct gm_triangulation *mesh,
                   char *sentence)
{
    const struct gm_user_room *user_room = flows->room;
    const enum gm_star star = (enum gm_star)flows->star;
    *mesh = (struct gm_triangulation){0};
    if (room && gm_flows_has_rectangle(flows)) {
        struct gm_rectangle rectangle = room->rectangle;
        mesh->complex = lay_rectangle(&rectangle, sentence);
        return mesh->complex != NULL;
    }
    const char *path = user_room->room.rectangular ? flows->mesh : user_room->mesh;
    if (!read_file(path, user_room->inside, star, mesh, sentence)) {
        return false;
    }
    const bool good = !room || flows->refine < 2 || refine(path, star, flows->refine, mesh, sentence);
    if (!good) {
        gm_triangulation_close(mesh);
    }
    return good;
}
