/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Oriented simplicial complexes in the plane, on a torus or on a surface in space, and what may be wrong with a
   triangulation. */
#ifndef GM_CORE_FORM_COMPLEX_H
#define GM_CORE_FORM_COMPLEX_H

#include <stdbool.h>
#include <stddef.h>

/* The faults of a mesh. The callers write the messages. */
enum gm_triangulation_fault_kind {
    GM_TRIANGULATION_OK,
    GM_TRIANGULATION_MEMORY,
    GM_TRIANGULATION_NOT_GMSH,      /* does not begin with $MeshFormat */
    GM_TRIANGULATION_VERSION,       /* text: the version; 2.2 and 4.1 are read */
    GM_TRIANGULATION_BYTES,         /* binary, in the byte order of another kind of machine */
    GM_TRIANGULATION_SYNTAX,        /* line; text: what is expected there */
    GM_TRIANGULATION_TRUNCATED,     /* text: the section that does not end */
    GM_TRIANGULATION_HUGE,          /* line: announces more than the file can hold, or than 5e6 */
    GM_TRIANGULATION_REPEATED_NODE, /* line, nodes[0] */
    GM_TRIANGULATION_UNKNOWN_NODE,  /* line, nodes[0] */
    GM_TRIANGULATION_ELEMENT,       /* line, nodes[0]: a type of element that is not read */
    GM_TRIANGULATION_THREE_D,       /* line, nodes[0]: a node off the plane */
    GM_TRIANGULATION_EMPTY,         /* no triangle */
    GM_TRIANGULATION_DEGENERATE,    /* triangle, nodes: no area */
    GM_TRIANGULATION_OVERLAP,       /* triangle, nodes: two triangles on the same side of an edge */
    GM_TRIANGULATION_EDGE_OF_THREE, /* nodes: an edge of three or more triangles */
    GM_TRIANGULATION_PINCHED,       /* nodes[0]: two pieces that meet in one vertex only */
    GM_TRIANGULATION_PIECES,        /* triangle, nodes: not of the first one's piece */
    GM_TRIANGULATION_ONE_SIDED,     /* nodes: an edge along which orientations of the surface disagree */
    /* triangle, nodes, value: its largest angle, opposite to a dual edge that is not positive; text: the least entry
       of the circumcentric star1 */
    GM_TRIANGULATION_NOT_DELAUNAY,
    GM_TRIANGULATION_DUAL_CELL, /* nodes[0]: a dual cell whose area is not positive */
};

struct gm_triangulation_fault {
    enum gm_triangulation_fault_kind kind;
    long line;     /* line of the file, from 1 */
    long triangle; /* from 1, in the order of the file */
    long nodes[3]; /* tags of a file's nodes, from 1 otherwise */
    double value;  /* an angle in degrees */
    char text[64];
};

/* Hodge stars: the choice of a triangle's dual vertex. Dual edges run from there through the
   middle of a side to the next one, and enclose dual cells. A gradient that is constant on a triangle flows
   through a path from one side's middle to another's whatever lies between, so K = d0' star1 d0 is the same
   for all of them, the matrix of linear finite elements. Cells (star0) and fluxes through dual edges differ.
       circumcentric: the circumcentre; dual edges are orthogonal to edges, star1 is diagonal. In obtuse
           triangles the parts of dual edges and cells keep their signs; every whole one must be positive
           (Delaunay).
       barycentric: the centre of mass; for any triangles. It is also the star of Galerkin: fluxes and K are
           those of linear elements, star0 is their mass matrix with its rows summed up.
       incentric: the centre of the circle inside; for any triangles. */
enum gm_star {
    GM_STAR_AUTO, /* circumcentric if that is positive, else barycentric */
    GM_STAR_CIRCUMCENTRIC,
    GM_STAR_BARYCENTRIC,
    GM_STAR_GALERKIN, /* the same as barycentric */
    GM_STAR_INCENTRIC,
};

/* An oriented two-dimensional simplicial complex with its dual. Triangles run counter-clockwise: in the plane
   seen from +z, on a closed surface from outside, on another one as its first triangle, piece by piece. Edges
   run from their lower to their higher vertex. The dual edge of e points from the
   triangle on the right of e to the one on its left. */
struct gm_complex {
    struct gm_arena *arena; /* holds the complex and its arrays */
    size_t vertices, edges, triangles;
    size_t coordinates;         /* 2, or 3 in space */
    double *point;              /* `coordinates` a vertex */
    double period[2];           /* periods of a torus; 0: none */
    int *triangle;              /* 3 vertices */
    int *triangle_edge;         /* 3 edges: t0 t1, t1 t2, t2 t0 */
    signed char *triangle_sign; /* 3: +1 where the triangle runs the edge from low to high (the matrix d1) */
    int *edge;                  /* 2 vertices, low and high (the matrix d0); in lexicographic order */
    int *edge_triangle;         /* 2: the triangles on its left and on its right, -1 for none */
    int *ring_start;            /* vertices + 1: where the neighbours of a vertex begin */
    int *ring_vertex;           /* 2 * edges: neighbours, in increasing order for each vertex */
    int *ring_edge;             /* 2 * edges: the edge to that neighbour */
    int *edge_ring;        /* 2 an edge: the place in the rings of its high vertex at its low one, and back */
    size_t boundary;       /* number of boundary edges */
    int *boundary_edge;    /* boundary edges, counter-clockwise, loop after loop */
    int *boundary_vertex;  /* the vertex where each begins */
    size_t loops;          /* connected pieces of the boundary */
    size_t *loop_start;    /* loops + 1: where each begins in boundary_edge */
    size_t *loop;          /* the loop of each boundary edge */
    size_t pieces, closed; /* connected pieces, and those without a boundary */
    /* The piece of each triangle and vertex, by the number of its first one. */
    int *triangle_piece, *vertex_piece;
    enum gm_star star; /* star that is used */
    double star_least; /* the least entry of the circumcentric star1 */
    size_t obtuse;     /* triangles with an angle above 90 degrees */
    double *length;    /* length of each edge */
    double *area;      /* area of each triangle */
    double *weight;    /* 3 a triangle: barycentric coordinates of its dual vertex (the matrix P) */
    double *star0;     /* area of the dual cells */
    /* (cot + cot) / 2 of the angles that face an edge, on the boundary one: the entries of K. Where the star
       is circumcentric it is |dual edge| / |edge|. */
    double *star1;
    double smallest_angle, largest_angle; /* degrees */
    /* The origin in a file: x and y axes in its coordinates, 0 if they are the same; and the number of
       repeated triangles. */
    struct gm_complex_origin {
        double axes[2][3];
        size_t repeated;
    } origin;
    double total_area, mean_edge;
};

/* Triangles on points, every one of which is used. */
struct gm_triangles {
    const double *points; /* 2 a vertex, or 3 */
    bool in_space;        /* 3; several pieces are allowed, and triangles are made to agree */
    size_t vertices;
    const int *corners; /* 3 vertices a triangle, in any orientation */
    size_t count;
    double period[2]; /* periods of a torus, with nearest images of triangles; 0: none */
    enum gm_star star;
    const long *tags; /* names of the points for a fault; NULL: they are numbered from 1 */
};

/* Builds the complex. Returns NULL with a fault if the mesh is not valid. */
struct gm_complex *gm_complex_open(const struct gm_triangles *from, struct gm_triangulation_fault *fault);
void gm_complex_close(void *complex); /* for arenas too */

/* A vertex in space: z is 0 in the plane. */
void gm_complex_vertex(const struct gm_complex *complex, size_t vertex, double point[3]);
/* The corners of a triangle, next to each other even on a torus: x0 y0 x1 y1 x2 y2. */
void gm_complex_corners(const struct gm_complex *complex, size_t triangle, double corners[6]);
/* The same with z: x0 y0 z0 .. z2. */
void gm_complex_corners_in_space(const struct gm_complex *complex, size_t triangle, double corners[9]);
/* The normal of a triangle with these corners in space, as long as twice its area. */
void gm_triangle_normal(const double corners[9], double normal[3]);

/* The edge between two vertices, or -1. */
int gm_complex_edge(const struct gm_complex *complex, int a, int b);

/* Cuts every triangle in four by the middles of its sides, which become the points after the vertices, in the
   order of the edges: room for as many points and for 12 corners a triangle. */
void gm_complex_quarter(const struct gm_complex *complex, double *points, int *corners);

/* The dual vertex of a triangle. */
void gm_complex_centre(const struct gm_complex *complex, size_t triangle, double centre[2]);

/* Barycentric coordinates of a point in a triangle of the plane; on a torus of its image next to the triangle. */
void gm_complex_coordinates(const struct gm_complex *complex, size_t triangle, const double x[2],
                            double w[3]);

/* The middle of an edge; not where a torus is cut. */
void gm_complex_middle(const struct gm_complex *complex, size_t edge, double middle[2]);

/* The boundary edge after another one on its loop, and before it. */
size_t gm_complex_next(const struct gm_complex *complex, size_t boundary_edge);
size_t gm_complex_previous(const struct gm_complex *complex, size_t boundary_edge);
/* The area that a loop encloses: positive of the outer one, negative of holes. */
double gm_complex_loop_area(const struct gm_complex *complex, size_t loop);

#endif
