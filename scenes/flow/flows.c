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

const char *const gm_flows_stars[] = {"auto", "circumcentric", "barycentric", "galerkin", NULL};

/* The faults of a mesh, after its name: @ is the line, %s the fault's text, %n a node, %e the nodes of an edge,
   %t a triangle. */
static const char *const wrong[] = {
    [GM_TRIANGULATION_NOT_GMSH] = " is not a Gmsh file: it does not begin with $MeshFormat",
    [GM_TRIANGULATION_VERSION] =
        " is of version %s; Gmsh files of versions 2.2 and 4.1 are read (save with Mesh.MshFileVersion = 4.1)",
    [GM_TRIANGULATION_BYTES] =
        " is binary, in the byte order of another machine; save it as ASCII (Mesh.Binary = 0)",
    [GM_TRIANGULATION_SYNTAX] = "@: expected %s",
    [GM_TRIANGULATION_TRUNCATED] = "@: the file ends within its section %s",
    [GM_TRIANGULATION_HUGE] = "@: %s is more than 5000000",
    [GM_TRIANGULATION_REPEATED_NODE] = "@: node %n is there twice",
    [GM_TRIANGULATION_UNKNOWN_NODE] = "@: there is no node %n",
    [GM_TRIANGULATION_ELEMENT] =
        "@: elements of type %n; only triangles of three or six nodes (types 2 and 9) and their sides are read",
    [GM_TRIANGULATION_THREE_D] = "@: node %n lies off the plane of the others; the mesh must be flat",
    [GM_TRIANGULATION_EMPTY] = " has no triangle",
    [GM_TRIANGULATION_DEGENERATE] = "@: %t has no area",
    [GM_TRIANGULATION_OVERLAP] = "@: %t overlaps its neighbour",
    [GM_TRIANGULATION_EDGE_OF_THREE] = ": the edge between nodes %e belongs to three triangles",
    [GM_TRIANGULATION_PINCHED] = ": at node %n the mesh hangs together by a point",
    [GM_TRIANGULATION_PIECES] = "@ is in several pieces: %t is not joined to triangle 1",
    [GM_TRIANGULATION_ONE_SIDED] = " cannot be oriented: its triangles disagree along the edge of nodes %e",
    [GM_TRIANGULATION_NOT_DELAUNAY] =
        "@: %t and a dual edge that is not positive; the mesh must be Delaunay, or star=barycentric",
    [GM_TRIANGULATION_DUAL_CELL] = ": the dual cell of node %n has no positive area",
};

/* Writes why a mesh was refused; `name` is "the mesh" or the file's. */
static void explain(const char *name, const struct gm_triangulation_fault *fault, char *sentence)
{
    const long *n = fault->nodes;
    char line[48] = "", angle[48] = "", thing[192] = "";
    if (fault->kind <= GM_TRIANGULATION_MEMORY) {
        gm_refuse(sentence, "not enough memory");
        return;
    }
    const bool where = wrong[fault->kind][0] == '@';
    const char *before = wrong[fault->kind] + where, *sign = strchr(before, '%');
    const char kind = sign ? sign[1] : '\0';
    if (where && fault->line > 0) {
        snprintf(line, sizeof line, ", line %ld", fault->line);
    }
    if (fault->kind == GM_TRIANGULATION_NOT_DELAUNAY) {
        snprintf(angle, sizeof angle, " has an angle of %.1f degrees", fault->value);
    }
    if (kind == 't') {
        snprintf(thing, sizeof thing, "triangle %ld (nodes %ld %ld %ld)%s", fault->triangle, n[0], n[1], n[2],
                 angle);
    } else if (kind == 'e') {
        snprintf(thing, sizeof thing, "%ld and %ld", n[0], n[1]);
    } else if (kind == 'n') {
        snprintf(thing, sizeof thing, "%ld", n[0]);
    }
    gm_refuse(sentence, "%.100s%s%.*s%s%s", name, line, (int)strcspn(before, "%"), before,
              kind == 's' ? fault->text : thing, sign ? sign + 2 : "");
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
