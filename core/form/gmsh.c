/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gmsh's file formats 2.2 and 4.1, ASCII and binary (Geuzaine & Remacle, Int.
   J. Numer. Meth. Eng. 79 (2009) 1309; Gmsh's reference manual, "MSH file
   format"): by tables of the sections to a complex with names on its edges. */
#include "core/form/gmsh.h"
#include "core/arena.h"
#include "core/basics.h"
#include "core/linear/vectors.h"

#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The largest number of nodes, elements or entities. */
enum { MOST = 5000000 };

struct node {
    long tag; /* first, by which nodes are compared */
    double at[3];
    long line;
    int vertex; /* -1: unused */
};

struct element {
    long nodes[3];
    long line;
    long entity; /* entity of a line; in 2.2 its physical tag */
};

/* A row for each physical group of a curve. */
struct curve {
    long tag, physical;
};

struct reader {
    struct gm_arena *arena; /* of the mesh */
    const char *at, *end;
    long line;
    struct gm_triangulation_fault *fault;
    const char *section;
    bool old;        /* version 2.2 */
    bool parametric; /* ... whose nodes have parameters on curves and surfaces */
    bool binary;     /* the file */
    bool entities;   /* they were read */
    bool raw;        /* the reader is in binary data */
    bool in_space;   /* nodes keep their three coordinates */
    struct node *nodes;
    struct element *triangles, *lines;
    struct curve *curves;
    struct gm_triangulation_group *groups;
    struct gm_triangulation_member *members; /* of edges, in the order of the lines */
    size_t node_count, triangle_count, line_count, curve_count, group_count, member_count;
    struct gm_complex_origin origin;
    enum gm_star star;
    struct gm_triangulation *mesh; /* the result */
};

/* The text: words, numbers, counts. Unexpected text leaves the arena with the reader's fault; `what` is
   the expected text. Announced counts are limited by the length of the text. */

/* Sets the fault, at the current line, and leaves. */
_Noreturn static void fail(struct reader *reader, enum gm_triangulation_fault_kind kind, const char *text)
{
    *reader->fault = (struct gm_triangulation_fault){.kind = kind, .line = reader->raw ? 0 : reader->line};
    snprintf(reader->fault->text, sizeof reader->fault->text, "%.*s", (int)sizeof reader->fault->text - 1,
             text);
    gm_arena_leave(reader->arena);
}

static void expect(struct reader *reader, bool there, const char *what)
{
    if (!there) {
        fail(reader, GM_TRIANGULATION_SYNTAX, what);
    }
}

_Noreturn static void fail_at_node(struct reader *reader, enum gm_triangulation_fault_kind kind, long line,
                                   long node)
{
    *reader->fault =
        (struct gm_triangulation_fault){.kind = kind, .line = reader->binary ? 0 : line, .nodes = {node}};
    gm_arena_leave(reader->arena);
}

/* Blanks and line ends, which are counted. */
static void skip_blanks(struct reader *reader)
{
    while (reader->at < reader->end && isspace((unsigned char)*reader->at)) {
        reader->line += *reader->at == '\n';
        reader->at++;
    }
}

/* The next word, at most size - 1 bytes of it; false, without a fault, at
 * the end or if it is longer. */
static bool take_word(struct reader *reader, char *word, size_t size)
{
    skip_blanks(reader);
    size_t length = 0;
    while (reader->at < reader->end && !isspace((unsigned char)*reader->at)) {
        if (length + 1 >= size) {
            return false;
        }
        word[length++] = *reader->at++;
    }
    word[length] = '\0';
    return length > 0;
}

/* Returns true if only blanks are left. */
static bool at_end(struct reader *reader)
{
    skip_blanks(reader);
    return reader->at >= reader->end;
}

/* Bytes as they are. */
static void take_raw(struct reader *reader, void *value, size_t size)
{
    if ((size_t)(reader->end - reader->at) < size) {
        fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
    }
    memcpy(value, reader->at, size);
    reader->at += size;
}

/* A word that has to be there. */
static void take_expected(struct reader *reader, char *word, size_t size, const char *what)
{
    if (at_end(reader)) {
        fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
    }
    expect(reader, take_word(reader, word, size), what);
}

static double take_number(struct reader *reader, const char *what)
{
    char word[64], *rest = word;
    double value = 0;
    if (reader->raw) {
        take_raw(reader, &value, sizeof value);
        word[0] = '\0';
    } else {
        take_expected(reader, word, sizeof word, what);
        value = strtod(word, &rest);
    }
    expect(reader, *rest == '\0' && isfinite(value), what);
    return value;
}

/* A whole number, of 4 bytes in binary files. */
static long take_whole(struct reader *reader, const char *what)
{
    char word[32], *rest = NULL;
    int32_t number = 0;
    if (reader->raw) {
        take_raw(reader, &number, sizeof number);
        return number;
    }
    take_expected(reader, word, sizeof word, what);
    const long value = strlen(word) > 18 ? 0 : strtol(word, &rest, 10);
    expect(reader, rest && *rest == '\0', what);
    return value;
}

/* A whole number of 8 bytes in binary files: a tag of a node or an element. */
static long take_tag(struct reader *reader, const char *what)
{
    const int64_t largest = 1000000000000000000;
    int64_t number = 0;
    if (!reader->raw || reader->old) {
        return take_whole(reader, what);
    }
    take_raw(reader, &number, sizeof number);
    expect(reader, number < largest && number > -largest, what);
    return (long)number;
}

/* A count of things that each need at least two bytes of the text that is left.
 */
static long take_count(struct reader *reader, const char *what)
{
    const long value = take_tag(reader, what);
    expect(reader, value >= 0, what);
    if (value > MOST) {
        fail(reader, GM_TRIANGULATION_HUGE, what);
    }
    if (value > (reader->end - reader->at) / 2 + 1) {
        fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
    }
    return value;
}

/* "$EndNodes" after the section "$Nodes" */
static void expect_end(struct reader *reader)
{
    char wanted[44], word[44];
    reader->raw = false;
    snprintf(wanted, sizeof wanted, "$End%s", reader->section + 1);
    take_expected(reader, word, sizeof word, wanted);
    expect(reader, strcmp(word, wanted) == 0, wanted);
}

/* The sections, as tables. */

/* types of elements */
enum { LINE = 1, TRIANGLE = 2, LINE_OF_3 = 8, TRIANGLE_OF_6 = 9, POINT = 15 };

/* Skips to the line's end, after which a binary file has binary data. */
static void begin_raw(struct reader *reader)
{
    while (reader->binary && reader->at < reader->end && *reader->at++ != '\n') {
    }
    reader->raw = reader->binary;
}

static void read_format(struct reader *reader)
{
    char version[16];
    expect(reader, take_word(reader, version, sizeof version), "a version");
    reader->old = strcmp(version, "2.2") == 0;
    if (!reader->old && strcmp(version, "4.1") != 0) {
        fail(reader, GM_TRIANGULATION_VERSION, version);
    }
    const long binary = take_whole(reader, "0 for ASCII, 1 for binary"), size = take_whole(reader, "a size");
    expect(reader, binary >= 0 && binary <= 1 && size == 8,
           "0 for ASCII or 1 for binary, and 8 for the size of numbers");
    reader->binary = binary == 1;
    begin_raw(reader);
    if (reader->raw && take_whole(reader, "1") != 1) {
        fail(reader, GM_TRIANGULATION_BYTES, "");
    }
}

static void read_names(struct reader *reader)
{
    expect(reader, !reader->groups, "one section $PhysicalNames");
    const long count = take_count(reader, "the number of names");
    reader->groups = gm_arena_take(reader->arena, (size_t)count + 1, sizeof *reader->groups);
    for (long i = 0; i < count; i++) {
        const long dimension = take_whole(reader, "a dimension"), tag = take_whole(reader, "a tag");
        skip_blanks(reader);
        expect(reader, reader->at < reader->end && *reader->at == '"', "a name in quotation marks");
        const char *name = ++reader->at;
        while (reader->at < reader->end && *reader->at != '"' && *reader->at != '\n') {
            reader->at++;
        }
        const size_t length = (size_t)(reader->at - name);
        expect(reader, reader->at < reader->end && *reader->at == '"' && length < sizeof reader->groups->name,
               "a name of at most 63 bytes in quotation marks");
        reader->at++;
        if (dimension == 1) {
            struct gm_triangulation_group *group = &reader->groups[reader->group_count++];
            group->tag = tag;
            memcpy(group->name, name, length);
        }
    }
}

static void skip_numbers(struct reader *reader, long count)
{
    for (long i = 0; i < count; i++) {
        take_number(reader, "a number");
    }
}

static void add_curve(struct reader *reader, long tag, long physical)
{
    reader->curves =
        gm_arena_grown(reader->arena, reader->curves, reader->curve_count, sizeof *reader->curves);
    reader->curves[reader->curve_count++] =
        (struct curve){tag, labs(physical)}; /* the sign is an orientation */
}

/* Reads the entity that a part belongs to, and its parts of the mesh; a part of a curve is also in the
   curve's groups. */
static void read_parent(struct reader *reader, long tag, int dimension)
{
    const long whole = take_whole(reader, "a dimension"), parent = take_whole(reader, "an entity's tag");
    for (long i = take_count(reader, "a number of parts"); i > 0; i--) {
        take_whole(reader, "a part");
    }
    const size_t known = reader->curve_count;
    for (size_t i = 0; dimension == 1 && whole == 1 && i < known; i++) {
        if (reader->curves[i].tag == parent && tag != parent) {
            add_curve(reader, tag, reader->curves[i].physical);
        }
    }
}

/* tag, of a part its whole, bounding box, physical tags and, from curves on,
 * bounding entities */
static void read_entity(struct reader *reader, int dimension, bool partitioned)
{
    const long tag = take_whole(reader, "an entity's tag");
    if (partitioned) {
        read_parent(reader, tag, dimension);
    }
    skip_numbers(reader, dimension == 0 ? 3 : 6);
    for (long i = take_count(reader, "the number of physical tags"); i > 0; i--) {
        const long physical = take_whole(reader, "a physical tag");
        if (dimension == 1 && labs(physical) < MOST) {
            add_curve(reader, tag, physical);
        }
    }
    for (long i = dimension == 0 ? 0 : take_count(reader, "a number of entities"); i > 0; i--) {
        take_whole(reader, "an entity's tag");
    }
}

static void read_all_entities(struct reader *reader, bool partitioned)
{
    long counts[4];
    for (int i = 0; i < 4; i++) {
        counts[i] = take_count(reader, "a number of entities");
    }
    for (int dimension = 0; dimension < 4; dimension++) {
        for (long i = 0; i < counts[dimension]; i++) {
            read_entity(reader, dimension, partitioned);
        }
    }
}

static void read_entities(struct reader *reader)
{
    expect(reader, !reader->entities, "one section $Entities");
    reader->entities = true;
    begin_raw(reader);
    read_all_entities(reader, false);
}

/* Reads the entities of a mesh in parts, which becomes one mesh; ghosts are
 * elements of neighbours. */
static void read_partitioned_entities(struct reader *reader)
{
    begin_raw(reader);
    take_count(reader, "a number of parts");
    for (long i = take_count(reader, "a number of ghosts"); i > 0; i--) {
        take_whole(reader, "a ghost's tag");
        take_whole(reader, "a part");
    }
    read_all_entities(reader, true);
}

static int compare_tags(const void *a, const void *b)
{
    const long p = *(const long *)a, q = *(const long *)b;
    return (p > q) - (p < q);
}

static void read_place(struct reader *reader, struct node *node)
{
    node->vertex = -1;
    for (int k = 0; k < 3; k++) {
        node->at[k] = take_number(reader, "a coordinate");
    }
}

static void read_node_block(struct reader *reader, size_t total)
{
    const long dimension = take_whole(reader, "a dimension");
    take_whole(reader, "an entity");
    const long parametric = take_whole(reader, "0 or 1"), count = take_count(reader, "a number of nodes");
    expect(reader, parametric >= 0 && parametric <= 1 && dimension >= 0 && dimension <= 3,
           "a dimension, an entity, 0 or 1, and a number of nodes");
    expect(reader, (size_t)count <= total - reader->node_count, "as many nodes as announced");
    struct node *nodes = reader->nodes + reader->node_count;
    for (long i = 0; i < count; i++) {
        nodes[i].tag = take_tag(reader, "a node's tag");
        nodes[i].line = reader->line;
    }
    for (long i = 0; i < count; i++) {
        read_place(reader, &nodes[i]);
        skip_numbers(reader, parametric ? dimension : 0);
    }
    reader->node_count += (size_t)count;
}

/* The nodes of version 2.2: each with its tag, and after one that has parameters the dimension and the tag
   of its entity, and the parameters. */
static void read_old_nodes(struct reader *reader, size_t total)
{
    begin_raw(reader);
    for (; reader->node_count < total; reader->node_count++) {
        struct node *node = &reader->nodes[reader->node_count];
        node->tag = take_whole(reader, "a node's tag");
        node->line = reader->line;
        read_place(reader, node);
        if (reader->parametric) {
            const long dimension = take_whole(reader, "a dimension");
            take_whole(reader, "a tag");
            skip_numbers(reader, dimension == 1 || dimension == 2 ? dimension : 0);
        }
    }
}

/* Reads the start of a section: numbers of blocks (not in 2.2) and entries, range of tags. Returns the
   number of entries. */
static size_t begin_blocks(struct reader *reader, long *blocks, const char *what)
{
    *blocks = 0;
    if (reader->old) {
        return (size_t)take_count(reader, what);
    }
    begin_raw(reader);
    *blocks = take_count(reader, "a number of blocks");
    const long total = take_count(reader, what);
    take_tag(reader, "a tag");
    take_tag(reader, "a tag");
    return (size_t)total;
}

static void read_nodes(struct reader *reader)
{
    long blocks;
    const size_t total = begin_blocks(reader, &blocks, "a number of nodes");
    expect(reader, !reader->nodes, "one section $Nodes");
    reader->nodes = gm_arena_take(reader->arena, total + 1, sizeof *reader->nodes);
    if (reader->old) {
        read_old_nodes(reader, total);
    }
    for (long i = 0; i < blocks; i++) {
        read_node_block(reader, total);
    }
    expect(reader, reader->node_count == total, "as many nodes as announced");
    qsort(reader->nodes, reader->node_count, sizeof *reader->nodes, compare_tags);
    for (size_t i = 1; i < reader->node_count; i++) {
        if (reader->nodes[i].tag == reader->nodes[i - 1].tag) {
            const long a = reader->nodes[i].line, b = reader->nodes[i - 1].line;
            fail_at_node(reader, GM_TRIANGULATION_REPEATED_NODE, a > b ? a : b, reader->nodes[i].tag);
        }
    }
}

static void read_parametric_nodes(struct reader *reader)
{
    reader->parametric = true;
    read_nodes(reader);
}

static int nodes_of(long type)
{
    static const signed char nodes[] = {
        [LINE] = 2, [TRIANGLE] = 3, [LINE_OF_3] = 3, [TRIANGLE_OF_6] = 6, [POINT] = 1};
    return type >= 0 && type < (long)GM_COUNT(nodes) ? nodes[type] : 0;
}

/* The nodes of an element, whose tag and further tags are read: the corners
   come first, and those on sides that may be curved are passed over. */
static void read_corners(struct reader *reader, long type, struct element element)
{
    for (int k = 0; k < nodes_of(type); k++) {
        const long tag = take_tag(reader, "a node's tag");
        expect(reader, reader->raw || reader->line == element.line, "the nodes of an element on its line");
        element.nodes[k < 3 ? k : 2] = k < 3 ? tag : element.nodes[2];
    }
    if (type == TRIANGLE || type == TRIANGLE_OF_6) {
        reader->triangles[reader->triangle_count++] = element;
    } else if (type == LINE || type == LINE_OF_3) {
        reader->lines[reader->line_count++] = element;
    }
}

static void expect_type(struct reader *reader, long type, long line)
{
    if (nodes_of(type) == 0) {
        fail_at_node(reader, GM_TRIANGULATION_ELEMENT, line, type);
    }
}

/* Reads a block of at most `left` elements; returns their number. In version 2.2 each has its tag, type, number
   of tags, those (the first is the physical one) and nodes; in binary files the type and the numbers of elements
   and tags precede their elements. */
static size_t read_element_block(struct reader *reader, size_t left)
{
    long entity = 0, type = 0, count = 1, tags = 0;
    if (!reader->old) {
        take_whole(reader, "a dimension");
        entity = take_whole(reader, "an entity");
    }
    if (!reader->old || reader->raw) {
        type = take_whole(reader, "a type of elements");
        count = reader->old ? take_whole(reader, "a number of elements")
                            : take_count(reader, "a number of elements");
    }
    if (!reader->old) {
        expect_type(reader, type, reader->line);
    } else if (reader->raw) {
        tags = take_whole(reader, "a number of tags");
    }
    expect(reader, count >= reader->old && (size_t)count <= left, "as many elements as announced");
    for (long i = 0; i < count; i++) {
        take_tag(reader, "an element's tag");
        struct element element = {.line = reader->line, .entity = entity};
        if (reader->old && !reader->raw) {
            type = take_whole(reader, "a type of elements");
            tags = take_count(reader, "a number of tags");
        }
        expect_type(reader, type, element.line);
        for (long k = 0; k < tags; k++) {
            const long tag = take_whole(reader, "a tag");
            element.entity = k == 0 && labs(tag) < MOST ? labs(tag) : element.entity;
        }
        read_corners(reader, type, element);
    }
    return (size_t)count;
}

static void read_elements(struct reader *reader)
{
    long blocks;
    size_t left = begin_blocks(reader, &blocks, "a number of elements");
    expect(reader, !reader->triangles, "one section $Elements");
    reader->triangles = gm_arena_take(reader->arena, left + 1, sizeof *reader->triangles);
    reader->lines = gm_arena_take(reader->arena, left + 1, sizeof *reader->lines);
    if (reader->old) {
        begin_raw(reader);
    }
    while (reader->old ? left > 0 : blocks-- > 0) {
        left -= read_element_block(reader, left);
    }
    expect(reader, left == 0, "as many elements as announced");
}

static void skip_section(struct reader *reader)
{
    char wanted[44];
    const size_t length = (size_t)snprintf(wanted, sizeof wanted, "$End%s", reader->section + 1);
    const char *end = memmem(reader->at, (size_t)(reader->end - reader->at), wanted, length);
    while (reader->at < (end ? end : reader->end)) {
        reader->line += *reader->at++ == '\n';
    }
    if (!end) {
        fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
    }
    reader->at += length;
}

/* Reads the whole text into the tables; nodes in the order of their tags. */
static void read_sections(struct reader *reader)
{
    static const struct {
        const char *name;
        void (*read)(struct reader *);
    } known[] = {
        {"$PhysicalNames", read_names},
        {"$Entities", read_entities},
        {"$PartitionedEntities", read_partitioned_entities},
        {"$Nodes", read_nodes},
        {"$ParametricNodes", read_parametric_nodes},
        {"$Elements", read_elements},
    };
    char section[40];
    if (!take_word(reader, section, sizeof section) || strcmp(section, "$MeshFormat") != 0) {
        fail(reader, GM_TRIANGULATION_NOT_GMSH, "");
    }
    reader->section = section;
    read_format(reader);
    expect_end(reader);
    while (!at_end(reader)) {
        expect(reader, take_word(reader, section, sizeof section) && section[0] == '$',
               "a section, such as $Nodes");
        bool met = false;
        for (size_t i = 0; i < GM_COUNT(known); i++) {
            if (strcmp(section, known[i].name) == 0) {
                met = true;
                known[i].read(reader);
                expect_end(reader);
            }
        }
        if (!met) {
            skip_section(reader);
        }
    }
}

/* The mesh. */

/* The number of an element's node in the order of tags. */
static long find_node(struct reader *reader, const struct element *element, size_t k)
{
    const long tag = element->nodes[k];
    const struct node *node = reader->node_count == 0 ? NULL
                                                      : bsearch(&tag, reader->nodes, reader->node_count,
                                                                sizeof *reader->nodes, compare_tags);
    if (!node) {
        fail_at_node(reader, GM_TRIANGULATION_UNKNOWN_NODE, element->line, tag);
    }
    return node - reader->nodes;
}

/* A triangle's nodes, ascending, and its index. */
struct corners {
    long nodes[3];
    size_t place;
};

static int compare_corners(const void *a, const void *b)
{
    const struct corners *p = a, *q = b;
    for (int k = 0; k < 3; k++) {
        if (p->nodes[k] != q->nodes[k]) {
            return p->nodes[k] > q->nodes[k] ? 1 : -1;
        }
    }
    return (p->place > q->place) - (p->place < q->place);
}

/* Version 2.2 writes a triangle once for each of its physical surfaces, and a
   surface that was meshed twice is there twice in any: the first stays. */
static void drop_repeated(struct reader *reader)
{
    const size_t tables = gm_arena_mark(reader->arena);
    struct corners *all = gm_arena_take(reader->arena, reader->triangle_count + 1, sizeof *all);
    for (size_t t = 0; t < reader->triangle_count; t++) {
        long *nodes = all[t].nodes;
        memcpy(nodes, reader->triangles[t].nodes, sizeof all[t].nodes);
        qsort(nodes, 3, sizeof *nodes, compare_tags);
        all[t].place = t;
    }
    qsort(all, reader->triangle_count, sizeof *all, compare_corners);
    for (size_t t = 1; t < reader->triangle_count; t++) {
        if (memcmp(all[t].nodes, all[t - 1].nodes, sizeof all[t].nodes) == 0) {
            reader->triangles[all[t].place].line = -1;
        }
    }
    gm_arena_release(reader->arena, tables);
    size_t count = 0;
    for (size_t t = 0; t < reader->triangle_count; t++) {
        reader->triangles[count] = reader->triangles[t];
        count += reader->triangles[t].line >= 0;
    }
    reader->origin.repeated = reader->old ? 0 : reader->triangle_count - count;
    reader->triangle_count = count;
}

/* Axes of the plane of the triangles: the first is the coordinate axis with the largest projection on it;
   seen so that triangles turn left. The plane of x and y if z is the same everywhere. */
static void choose_axes(struct reader *reader)
{
    double normal[3] = {0}, (*axes)[3] = reader->origin.axes;
    for (size_t t = 0; t < reader->triangle_count; t++) {
        double corners[9], one[3];
        for (int k = 0; k < 9; k++) {
            corners[k] = reader->nodes[reader->triangles[t].nodes[k / 3]].at[k % 3];
        }
        gm_triangle_normal(corners, one);
        for (int k = 0; k < 3; k++) {
            normal[k] += one[k];
        }
    }
    const double size = gm_length(normal);
    int first = 0;
    for (int k = 0; k < 3; k++) {
        normal[k] /= size > 0 ? size : 1;
        first = fabs(normal[k]) < fabs(normal[first]) ? k : first;
    }
    const double rest = sqrt(1 - normal[first] * normal[first]);
    for (int k = 0; k < 3; k++) {
        axes[0][k] = ((k == first) - normal[first] * normal[k]) / rest;
    }
    gm_cross(normal, axes[0], axes[1]);
}

/* Takes the nodes of triangles into the plane where they lie: x and y are their places there. */
static void lay_flat(struct reader *reader)
{
    double(*axes)[3] = reader->origin.axes, low[3] = {INFINITY, INFINITY, INFINITY},
    high[3] = {-INFINITY, -INFINITY, -INFINITY}, extent = 0, from[3], at[3];
    size_t first = 0;
    for (size_t i = reader->node_count; i-- > 0;) {
        const struct node *node = &reader->nodes[i];
        for (int k = 0; k < 3 && node->vertex >= 0; k++) {
            low[k] = fmin(low[k], node->at[k]);
            high[k] = fmax(high[k], node->at[k]);
            extent = fmax(extent, high[k] - low[k]);
            first = i;
        }
    }
    if (high[2] - low[2] <= 1e-9 * extent) {
        return;
    }
    choose_axes(reader);
    memcpy(from, reader->nodes[first].at, sizeof from);
    for (size_t i = 0; i < reader->node_count; i++) {
        struct node *node = &reader->nodes[i];
        gm_subtract(node->at, from, at);
        const double place[2] = {gm_dot(axes[0], at), gm_dot(axes[1], at)};
        double off = 0;
        for (int k = 0; k < 3; k++) {
            off = fmax(off, fabs(at[k] - place[0] * axes[0][k] - place[1] * axes[1][k]));
        }
        if (node->vertex >= 0 && !(off <= 1e-9 * extent)) {
            fail_at_node(reader, GM_TRIANGULATION_THREE_D, node->line, node->tag);
        }
        for (int c = 0; c < 2; c++) {
            node->at[c] = place[c] + axes[c][0] * from[0] + axes[c][1] * from[1] + axes[c][2] * from[2];
        }
    }
}

static int compare_curves(const void *a, const void *b)
{
    const struct curve *p = a, *q = b;
    return p->tag != q->tag ? (p->tag > q->tag) - (p->tag < q->tag)
                            : (p->physical > q->physical) - (p->physical < q->physical);
}

static void add_group(struct reader *reader, long tag)
{
    for (size_t i = 0; i < reader->group_count; i++) {
        if (reader->groups[i].tag == tag) {
            return;
        }
    }
    reader->groups =
        gm_arena_resize(reader->arena, reader->groups, reader->group_count + 1, sizeof *reader->groups);
    struct gm_triangulation_group *group = &reader->groups[reader->group_count++];
    group->tag = tag;
    snprintf(group->name, sizeof group->name, "%ld", tag);
}

/* Groups of edges that have no name are named by their number: the first of each edge, then others. */
static void number_groups(struct reader *reader)
{
    const struct gm_triangulation *mesh = reader->mesh;
    for (int others = 0; others < 2; others++) {
        for (size_t e = 0; e < mesh->complex->edges; e++) {
            for (int k = mesh->member_start[e] + others; k < mesh->member_start[e + 1]; k++) {
                add_group(reader, mesh->member[k]);
                if (!others) {
                    break;
                }
            }
        }
    }
}

static void put_into(struct reader *reader, int edge, long group)
{
    reader->members =
        gm_arena_grown(reader->arena, reader->members, reader->member_count, sizeof *reader->members);
    reader->members[reader->member_count++] = (struct gm_triangulation_member){edge, (int)group};
}

/* Puts an edge into all groups of its curve. */
static void add_groups_of(struct reader *reader, long entity, int edge)
{
    size_t low = 0, high = reader->curve_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        low = reader->curves[middle].tag < entity ? middle + 1 : low;
        high = reader->curves[middle].tag < entity ? high : middle;
    }
    for (; low < reader->curve_count && reader->curves[low].tag == entity; low++) {
        put_into(reader, edge, reader->curves[low].physical);
    }
}

/* Names edges; lines that are not an edge of a triangle are ignored. */
static void name_edges(struct reader *reader)
{
    if (reader->curve_count > 0) {
        qsort(reader->curves, reader->curve_count, sizeof *reader->curves, compare_curves);
    }
    for (size_t i = 0; i < reader->line_count; i++) {
        const struct element *element = &reader->lines[i];
        const int a = reader->nodes[find_node(reader, element, 0)].vertex,
                  b = reader->nodes[find_node(reader, element, 1)].vertex,
                  e = a >= 0 && b >= 0 ? gm_complex_edge(reader->mesh->complex, a, b) : -1;
        if (e >= 0 && reader->old) {
            put_into(reader, e, element->entity);
        } else if (e >= 0) {
            add_groups_of(reader, element->entity, e);
        }
    }
    gm_triangulation_join(reader->mesh, reader->members, reader->member_count);
    number_groups(reader);
}

static void read_mesh(struct gm_arena *arena, void *data)
{
    struct reader *reader = data;
    struct gm_triangulation *mesh = reader->mesh;
    reader->arena = arena;
    read_sections(reader);
    if (reader->triangle_count == 0) {
        fail(reader, GM_TRIANGULATION_EMPTY, "");
    }
    const size_t triangles = reader->triangle_count;
    for (size_t i = 0; i < 3 * triangles; i++) {
        struct element *element = &reader->triangles[i / 3];
        element->nodes[i % 3] = find_node(reader, element, i % 3);
        reader->nodes[element->nodes[i % 3]].vertex = 0;
    }
    drop_repeated(reader);
    if (!reader->in_space) {
        lay_flat(reader);
    }
    const size_t coordinates = reader->in_space ? 3 : 2;
    double *points = gm_arena_take(arena, coordinates * reader->node_count, sizeof *points);
    int *corners = gm_arena_take(arena, 3 * triangles, sizeof *corners);
    struct gm_triangles from = {.points = points,
                                .in_space = reader->in_space,
                                .corners = corners,
                                .count = reader->triangle_count,
                                .star = reader->star};
    mesh->tags = gm_arena_take(arena, reader->node_count, sizeof *mesh->tags);
    for (size_t i = 0; i < reader->node_count; i++) { /* in the order of tags */
        struct node *node = &reader->nodes[i];
        if (node->vertex >= 0) {
            memcpy(points + coordinates * from.vertices, node->at, coordinates * sizeof *points);
            mesh->tags[from.vertices] = node->tag;
            node->vertex = (int)from.vertices++;
        }
    }
    for (size_t i = 0; i < 3 * from.count; i++) {
        corners[i] = reader->nodes[reader->triangles[i / 3].nodes[i % 3]].vertex;
    }
    from.tags = mesh->tags;
    mesh->complex = gm_complex_open(&from, reader->fault);
    if (!mesh->complex) {
        const long triangle = reader->fault->triangle;
        reader->fault->line =
            triangle > 0 && !reader->binary ? reader->triangles[triangle - 1].line : reader->fault->line;
        gm_arena_leave(arena);
    }
    reader->fault->kind = GM_TRIANGULATION_MEMORY; /* unless it is another one */
    mesh->complex->origin = reader->origin;
    name_edges(reader);
    mesh->group = reader->groups;
    mesh->groups = reader->group_count;
    reader->fault->kind = GM_TRIANGULATION_OK;
}

static bool read_text(const char *text, size_t size, struct reader reader)
{
    struct gm_triangulation *mesh = reader.mesh;
    reader.at = text;
    reader.end = text + size;
    reader.line = 1;
    reader.section = "";
    *mesh = (struct gm_triangulation){.arena = gm_arena_open()};
    *reader.fault = (struct gm_triangulation_fault){.kind = GM_TRIANGULATION_MEMORY};
    if (!gm_arena_run(mesh->arena, read_mesh, &reader)) {
        gm_triangulation_close(mesh);
        return false;
    }
    return true;
}

bool gm_triangulation_read(const char *text, size_t size, enum gm_star star, struct gm_triangulation *mesh,
                           struct gm_triangulation_fault *fault)
{
    return read_text(text, size, (struct reader){.star = star, .mesh = mesh, .fault = fault});
}

bool gm_triangulation_read_in_space(const char *text, size_t size, enum gm_star star,
                                    struct gm_triangulation *mesh, struct gm_triangulation_fault *fault)
{
    return read_text(text, size,
                     (struct reader){.star = star, .in_space = true, .mesh = mesh, .fault = fault});
}

void gm_triangulation_close(void *mesh)
{
    struct gm_triangulation *self = mesh;
    gm_complex_close(self->complex);
    gm_arena_close(self->arena);
    *self = (struct gm_triangulation){0};
}

int gm_triangulation_first(const struct gm_triangulation *mesh, size_t edge)
{
    const int *start = mesh->member_start + edge;
    return start[0] < start[1] ? mesh->member[start[0]] : 0;
}

bool gm_triangulation_has(const struct gm_triangulation *mesh, size_t edge, long tag)
{
    int k = mesh->member_start[edge];
    while (k < mesh->member_start[edge + 1] && mesh->member[k] != tag) {
        k++;
    }
    return k < mesh->member_start[edge + 1];
}

void gm_triangulation_join(struct gm_triangulation *mesh, const struct gm_triangulation_member *members,
                           size_t count)
{
    const size_t edges = mesh->complex->edges;
    int *start = mesh->member_start = gm_arena_take(mesh->arena, edges + 1, sizeof *start);
    mesh->member = gm_arena_take(mesh->arena, count + 1, sizeof *mesh->member);
    for (size_t i = 0; i < count; i++) {
        start[members[i].edge + 1] += members[i].tag != 0;
    }
    for (size_t e = 0; e < edges; e++) {
        start[e + 1] += start[e];
    }
    for (size_t i = 0; i < count; i++) {
        if (members[i].tag != 0) {
            mesh->member[start[members[i].edge]++] = members[i].tag;
        }
    }
    memmove(start + 1, start, edges * sizeof *start);
    start[0] = 0;
    mesh->members = (size_t)start[edges];
}

long gm_triangulation_group(const struct gm_triangulation *mesh, const char *name)
{
    for (size_t i = 0; i < mesh->groups; i++) {
        if (strcmp(mesh->group[i].name, name) == 0) {
            return mesh->group[i].tag;
        }
    }
    char *rest = NULL;
    const long tag = strtol(name, &rest, 10);
    for (size_t k = 0; rest != name && *rest == '\0' && k < mesh->members; k++) {
        if (mesh->member[k] == tag) {
            return tag;
        }
    }
    return 0;
}

const char *gm_triangulation_group_names(const struct gm_triangulation *mesh, char *names, size_t size)
{
    snprintf(names, size, "none");
    for (size_t i = 0, used = 0; i < mesh->groups && used + sizeof mesh->group->name + 2 < size; i++) {
        used += (size_t)snprintf(names + used, size - used, "%s%s", i ? ", " : "", mesh->group[i].name);
    }
    return names;
}

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

const char *gm_triangulation_explain(const char *name, const struct gm_triangulation_fault *fault,
                                     char sentence[GM_TRIANGULATION_SENTENCE])
{
    const long *n = fault->nodes;
    char line[48] = "", angle[48] = "", thing[192] = "";
    if (fault->kind <= GM_TRIANGULATION_MEMORY) {
        return "not enough memory";
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
    snprintf(sentence, GM_TRIANGULATION_SENTENCE, "%.100s%s%.*s%s%s", name, line, (int)strcspn(before, "%"),
             before, kind == 's' ? fault->text : thing, sign ? sign + 2 : "");
    return sentence;
}
