/* SPDX-License-Identifier: GPL-3.0-or-later */
#ifndef GM_CORE_FLOW_GMSH_READER_H
#define GM_CORE_FLOW_GMSH_READER_H

#include "core/flow/gmsh/gmsh.h"

/* A Gmsh file on its way to a mesh: its text, and the tables that are made of its sections. */

/* At most so many nodes, elements and entities are read. */
enum { GM_GMSH_MOST = 5000000 };

struct gm_gmsh_node {
    long tag;
    double x, y, z;
    long line;
    int vertex; /* -1: unused */
};

struct gm_gmsh_element {
    long nodes[3];
    long line;
    long entity; /* of a line */
};

struct gm_gmsh_curve {
    long tag, physical;
};

struct gm_gmsh_reader {
    const char *at, *end;
    long line;
    struct gm_triangulation_fault *fault;
    const char *section;
    struct gm_gmsh_node *nodes;
    struct gm_gmsh_element *triangles, *lines;
    struct gm_gmsh_curve *curves;
    struct gm_triangulation_group *groups;
    size_t node_count, triangle_count, line_count, curve_count, group_count;
};

/* All that follow return false with the reader's fault where the text is not what is expected; `what` says in
   words what that is. Announced counts are believed only as far as the text is long. */

/* Sets the fault, at the present line or at that of a node; false. */
bool gm_gmsh_fail(struct gm_gmsh_reader *reader, enum gm_triangulation_fault_kind kind, const char *text);
bool gm_gmsh_fail_at_node(struct gm_gmsh_reader *reader, enum gm_triangulation_fault_kind kind, long line,
                          long node);

/* Blanks and line ends, which are counted. */
void gm_gmsh_skip_blanks(struct gm_gmsh_reader *reader);
/* Whether nothing but blanks is left. */
bool gm_gmsh_at_end(struct gm_gmsh_reader *reader);
/* The next word, at most size - 1 bytes of it; false, without a fault, at the end or where it is longer. */
bool gm_gmsh_take_word(struct gm_gmsh_reader *reader, char *word, size_t size);
bool gm_gmsh_take_number(struct gm_gmsh_reader *reader, double *value, const char *what);
bool gm_gmsh_take_whole(struct gm_gmsh_reader *reader, long *value, const char *what);
/* A count of things that each need at least two bytes of the text that is left. */
bool gm_gmsh_take_count(struct gm_gmsh_reader *reader, long *value, const char *what);
/* "$EndNodes" after the section "$Nodes" */
bool gm_gmsh_expect_end(struct gm_gmsh_reader *reader);

/* Reads the whole text into the tables; nodes in the order of their tags. */
bool gm_gmsh_read_sections(struct gm_gmsh_reader *reader);
/* By tag; NULL if there is none. */
struct gm_gmsh_node *gm_gmsh_find_node(const struct gm_gmsh_reader *reader, long tag);

#endif
