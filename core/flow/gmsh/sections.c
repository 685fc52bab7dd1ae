/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The sections of a Gmsh file, as tables. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/flow/gmsh/reader.h"

/* types of elements */
enum { LINE = 1, TRIANGLE = 2, POINT = 15 };

static bool read_format(struct gm_gmsh_reader *reader)
{
    char version[16];
    long binary = 0, size = 0;
    if (!gm_gmsh_take_word(reader, version, sizeof version)) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, "a version");
    }
    if (strcmp(version, "4.1") != 0) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_VERSION, version);
    }
    if (!gm_gmsh_take_whole(reader, &binary, "0 for ASCII") || !gm_gmsh_take_whole(reader, &size, "a size")) {
        return false;
    }
    return binary == 0 || gm_gmsh_fail(reader, GM_TRIANGULATION_BINARY, "");
}

static bool read_names(struct gm_gmsh_reader *reader)
{
    long count = 0;
    if (reader->groups || !gm_gmsh_take_count(reader, &count, "the number of names")) {
        return reader->groups ? gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, "one section $PhysicalNames")
                              : false;
    }
    reader->groups = calloc((size_t)count + 1, sizeof *reader->groups);
    if (!reader->groups) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_MEMORY, "");
    }
    for (long i = 0; i < count; i++) {
        long dimension = 0, tag = 0;
        if (!gm_gmsh_take_whole(reader, &dimension, "a dimension") ||
            !gm_gmsh_take_whole(reader, &tag, "a tag")) {
            return false;
        }
        gm_gmsh_skip_blanks(reader);
        if (reader->at >= reader->end || *reader->at != '"') {
            return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, "a name in quotation marks");
        }
        const char *name = ++reader->at;
        while (reader->at < reader->end && *reader->at != '"' && *reader->at != '\n') {
            reader->at++;
        }
        const size_t length = (size_t)(reader->at - name);
        if (reader->at >= reader->end || *reader->at != '"' || length >= sizeof reader->groups->name) {
            return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX,
                                "a name of at most 63 bytes in quotation marks");
        }
        reader->at++;
        if (dimension == 1) {
            struct gm_triangulation_group *group = &reader->groups[reader->group_count++];
            group->tag = tag;
            memcpy(group->name, name, length);
        }
    }
    return true;
}

static bool skip_numbers(struct gm_gmsh_reader *reader, long count)
{
    double value = 0;
    for (long i = 0; i < count; i++) {
        if (!gm_gmsh_take_number(reader, &value, "a number")) {
            return false;
        }
    }
    return true;
}

/* tag, bounding box, physical tags and, from curves on, bounding entities */
static bool read_entity(struct gm_gmsh_reader *reader, int dimension)
{
    long tag = 0, count = 0, physical = 0, first = 0;
    if (!gm_gmsh_take_whole(reader, &tag, "an entity's tag") ||
        !skip_numbers(reader, dimension == 0 ? 3 : 6) ||
        !gm_gmsh_take_count(reader, &count, "the number of physical tags")) {
        return false;
    }
    for (long i = 0; i < count; i++) {
        if (!gm_gmsh_take_whole(reader, &physical, "a physical tag")) {
            return false;
        }
        first =
            i == 0 && labs(physical) < GM_GMSH_MOST ? labs(physical) : first; /* the sign is an orientation */
    }
    if (dimension == 1) {
        reader->curves[reader->curve_count++] = (struct gm_gmsh_curve){tag, first};
    }
    long bounds = 0;
    return dimension == 0 ||
           (gm_gmsh_take_count(reader, &bounds, "a number of entities") && skip_numbers(reader, bounds));
}

static bool read_entities(struct gm_gmsh_reader *reader)
{
    long counts[4];
    for (int i = 0; i < 4; i++) {
        if (!gm_gmsh_take_count(reader, &counts[i], "a number of entities")) {
            return false;
        }
    }
    if (reader->curves) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, "one section $Entities");
    }
    reader->curves = calloc((size_t)counts[1] + 1, sizeof *reader->curves);
    if (!reader->curves) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_MEMORY, "");
    }
    for (int dimension = 0; dimension < 4; dimension++) {
        for (long i = 0; i < counts[dimension]; i++) {
            if (!read_entity(reader, dimension)) {
                return false;
            }
        }
    }
    return true;
}

static int compare_nodes(const void *a, const void *b)
{
    const struct gm_gmsh_node *p = a, *q = b;
    return (p->tag > q->tag) - (p->tag < q->tag);
}

static bool read_node_block(struct gm_gmsh_reader *reader, size_t total)
{
    long dimension = 0, entity = 0, parametric = 0, count = 0;
    if (!gm_gmsh_take_whole(reader, &dimension, "a dimension") ||
        !gm_gmsh_take_whole(reader, &entity, "an entity") ||
        !gm_gmsh_take_whole(reader, &parametric, "0 or 1") ||
        !gm_gmsh_take_count(reader, &count, "a number of nodes")) {
        return false;
    }
    if (parametric < 0 || parametric > 1 || dimension < 0 || dimension > 3) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX,
                            "a dimension, an entity, 0 or 1, and a number of nodes");
    }
    if ((size_t)count > total - reader->node_count) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, "as many nodes as announced");
    }
    struct gm_gmsh_node *nodes = reader->nodes + reader->node_count;
    for (long i = 0; i < count; i++) {
        if (!gm_gmsh_take_whole(reader, &nodes[i].tag, "a node's tag")) {
            return false;
        }
        nodes[i].line = reader->line;
    }
    for (long i = 0; i < count; i++) {
        if (!gm_gmsh_take_number(reader, &nodes[i].x, "a coordinate") ||
            !gm_gmsh_take_number(reader, &nodes[i].y, "a coordinate") ||
            !gm_gmsh_take_number(reader, &nodes[i].z, "a coordinate") ||
            !skip_numbers(reader, parametric ? dimension : 0)) {
            return false;
        }
    }
    reader->node_count += (size_t)count;
    return true;
}

static bool read_nodes(struct gm_gmsh_reader *reader)
{
    long blocks = 0, total = 0, low = 0, high = 0;
    if (!gm_gmsh_take_count(reader, &blocks, "a number of blocks") ||
        !gm_gmsh_take_count(reader, &total, "a number of nodes") ||
        !gm_gmsh_take_whole(reader, &low, "a tag") || !gm_gmsh_take_whole(reader, &high, "a tag")) {
        return false;
    }
    if (reader->nodes) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, "one section $Nodes");
    }
    reader->nodes = calloc((size_t)total + 1, sizeof *reader->nodes);
    if (!reader->nodes) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_MEMORY, "");
    }
    for (long i = 0; i < blocks; i++) {
        if (!read_node_block(reader, (size_t)total)) {
            return false;
        }
    }
    if (reader->node_count != (size_t)total) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, "as many nodes as announced");
    }
    qsort(reader->nodes, reader->node_count, sizeof *reader->nodes, compare_nodes);
    for (size_t i = 1; i < reader->node_count; i++) {
        if (reader->nodes[i].tag == reader->nodes[i - 1].tag) {
            const long a = reader->nodes[i].line, b = reader->nodes[i - 1].line;
            return gm_gmsh_fail_at_node(reader, GM_TRIANGULATION_REPEATED_NODE, a > b ? a : b,
                                        reader->nodes[i].tag);
        }
    }
    return true;
}

static bool read_element_block(struct gm_gmsh_reader *reader, size_t total, size_t *done)
{
    long dimension = 0, entity = 0, type = 0, count = 0, tag = 0;
    if (!gm_gmsh_take_whole(reader, &dimension, "a dimension") ||
        !gm_gmsh_take_whole(reader, &entity, "an entity") ||
        !gm_gmsh_take_whole(reader, &type, "a type of elements") ||
        !gm_gmsh_take_count(reader, &count, "a number of elements")) {
        return false;
    }
    if (type != LINE && type != TRIANGLE && type != POINT) {
        return gm_gmsh_fail_at_node(reader, GM_TRIANGULATION_ELEMENT, reader->line, type);
    }
    if ((size_t)count > total - *done) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, "as many elements as announced");
    }
    *done += (size_t)count;
    for (long i = 0; i < count; i++) {
        struct gm_gmsh_element element = {.entity = entity};
        if (!gm_gmsh_take_whole(reader, &tag, "an element's tag")) {
            return false;
        }
        element.line = reader->line;
        const int corners = type == POINT ? 1 : type == LINE ? 2 : 3;
        for (int k = 0; k < corners; k++) {
            if (!gm_gmsh_take_whole(reader, &element.nodes[k], "a node's tag")) {
                return false;
            }
            if (reader->line != element.line) {
                return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, "the nodes of an element on its line");
            }
        }
        if (type == TRIANGLE) {
            reader->triangles[reader->triangle_count++] = element;
        } else if (type == LINE) {
            reader->lines[reader->line_count++] = element;
        }
    }
    return true;
}

static bool read_elements(struct gm_gmsh_reader *reader)
{
    long blocks = 0, total = 0, low = 0, high = 0;
    if (!gm_gmsh_take_count(reader, &blocks, "a number of blocks") ||
        !gm_gmsh_take_count(reader, &total, "a number of elements") ||
        !gm_gmsh_take_whole(reader, &low, "a tag") || !gm_gmsh_take_whole(reader, &high, "a tag")) {
        return false;
    }
    if (reader->triangles) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, "one section $Elements");
    }
    reader->triangles = calloc((size_t)total + 1, sizeof *reader->triangles);
    reader->lines = calloc((size_t)total + 1, sizeof *reader->lines);
    if (!reader->triangles || !reader->lines) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_MEMORY, "");
    }
    size_t done = 0;
    for (long i = 0; i < blocks; i++) {
        if (!read_element_block(reader, (size_t)total, &done)) {
            return false;
        }
    }
    return done == (size_t)total ||
           gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, "as many elements as announced");
}

static bool skip_section(struct gm_gmsh_reader *reader)
{
    char wanted[44];
    const int length = snprintf(wanted, sizeof wanted, "$End%s", reader->section + 1);
    while (reader->at < reader->end) {
        if ((size_t)(reader->end - reader->at) >= (size_t)length &&
            memcmp(reader->at, wanted, (size_t)length) == 0) {
            reader->at += length;
            return true;
        }
        reader->line += *reader->at++ == '\n';
    }
    return gm_gmsh_fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
}

bool gm_gmsh_read_sections(struct gm_gmsh_reader *reader)
{
    static const struct {
        const char *name;
        bool (*read)(struct gm_gmsh_reader *);
    } known[] = {
        {"$PhysicalNames", read_names},
        {"$Entities", read_entities},
        {"$Nodes", read_nodes},
        {"$Elements", read_elements},
    };
    char section[40];
    if (!gm_gmsh_take_word(reader, section, sizeof section) || strcmp(section, "$MeshFormat") != 0) {
        return gm_gmsh_fail(reader, GM_TRIANGULATION_NOT_GMSH, "");
    }
    reader->section = section;
    if (!read_format(reader) || !gm_gmsh_expect_end(reader)) {
        return false;
    }
    while (!gm_gmsh_at_end(reader)) {
        if (!gm_gmsh_take_word(reader, section, sizeof section) || section[0] != '$') {
            return gm_gmsh_fail(reader, GM_TRIANGULATION_SYNTAX, "a section, such as $Nodes");
        }
        bool met = false;
        for (size_t i = 0; i < sizeof known / sizeof known[0]; i++) {
            if (strcmp(section, known[i].name) == 0) {
                met = true;
                if (!known[i].read(reader) || !gm_gmsh_expect_end(reader)) {
                    return false;
                }
            }
        }
        if (!met && !skip_section(reader)) {
            return false;
        }
    }
    return true;
}

struct gm_gmsh_node *gm_gmsh_find_node(const struct gm_gmsh_reader *reader, long tag)
{
    const struct gm_gmsh_node key = {.tag = tag};
    return reader->node_count == 0
               ? NULL
               : bsearch(&key, reader->nodes, reader->node_count, sizeof *reader->nodes, compare_nodes);
}
