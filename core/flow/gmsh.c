/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Gmsh's file formats 2.2 and 4.1, ASCII and binary (Geuzaine & Remacle, Int. J. Numer. Meth. Eng. 79 (2009)
   1309; Gmsh's reference manual, "MSH file format"): by tables of the sections to a complex with names on its
   edges. */
#include "core/flow/gmsh.h"
#include "core/basics.h"

#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A Gmsh file on its way to a mesh: its text, and the tables that are made of its sections. */

/* At most so many nodes, elements and entities are read. */
enum { MOST = 5000000 };

struct node {
    long tag;
    double x, y, z;
    long line;
    int vertex; /* -1: unused */
};

struct element {
    long nodes[3];
    long line;
    long entity; /* of a line; in 2.2 its physical tag */
};

/* A row for each physical group of a curve. */
struct curve {
    long tag, physical;
};

struct reader {
    const char *at, *end;
    long line;
    struct gm_triangulation_fault *fault;
    const char *section;
    bool old;        /* version 2.2 */
    bool parametric; /* ... whose nodes have parameters on curves and surfaces */
    bool binary;     /* the file */
    bool entities;   /* they were read */
    bool raw;        /* what is read now: bytes as they are in memory */
    struct node *nodes;
    struct element *triangles, *lines;
    struct curve *curves;
    struct gm_triangulation_group *groups;
    size_t node_count, triangle_count, line_count, curve_count, group_count;
    struct gm_complex_origin origin;
};

/* The text: words, numbers, counts. All return false with the reader's fault where the text is not what is
   expected; `what` says in words what that is. Announced counts are believed only as far as the text is
   long. */

/* Sets the fault, at the present line; false. */
static bool fail(struct reader *reader, enum gm_triangulation_fault_kind kind, const char *text)
{
    *reader->fault = (struct gm_triangulation_fault){.kind = kind, .line = reader->raw ? 0 : reader->line};
    snprintf(reader->fault->text, sizeof reader->fault->text, "%.*s", (int)sizeof reader->fault->text - 1,
             text);
    return false;
}

static bool fail_at_node(struct reader *reader, enum gm_triangulation_fault_kind kind, long line, long node)
{
    *reader->fault =
        (struct gm_triangulation_fault){.kind = kind, .line = reader->binary ? 0 : line, .nodes = {node}};
    return false;
}

/* Blanks and line ends, which are counted. */
static void skip_blanks(struct reader *reader)
{
    while (reader->at < reader->end && isspace((unsigned char)*reader->at)) {
        reader->line += *reader->at == '\n';
        reader->at++;
    }
}

/* The next word, at most size - 1 bytes of it; false, without a fault, at the end or where it is longer. */
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

/* Whether nothing but blanks is left. */
static bool at_end(struct reader *reader)
{
    skip_blanks(reader);
    return reader->at >= reader->end;
}

/* Bytes as they are. */
static bool take_raw(struct reader *reader, void *value, size_t size)
{
    if ((size_t)(reader->end - reader->at) < size) {
        return fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
    }
    memcpy(value, reader->at, size);
    reader->at += size;
    return true;
}

static bool take_number(struct reader *reader, double *value, const char *what)
{
    char word[64], *rest = NULL;
    if (reader->raw) {
        return take_raw(reader, value, sizeof *value) &&
               (isfinite(*value) || fail(reader, GM_TRIANGULATION_SYNTAX, what));
    }
    if (at_end(reader)) {
        return fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
    }
    if (!take_word(reader, word, sizeof word)) {
        return fail(reader, GM_TRIANGULATION_SYNTAX, what);
    }
    *value = strtod(word, &rest);
    return (*rest == '\0' && isfinite(*value)) || fail(reader, GM_TRIANGULATION_SYNTAX, what);
}

/* A whole number: of 4 bytes where they are raw. */
static bool take_whole(struct reader *reader, long *value, const char *what)
{
    char word[32], *rest = NULL;
    if (reader->raw) {
        int32_t number = 0;
        const bool good = take_raw(reader, &number, sizeof number);
        *value = number;
        return good;
    }
    if (at_end(reader)) {
        return fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
    }
    if (!take_word(reader, word, sizeof word) || strlen(word) > 18) {
        return fail(reader, GM_TRIANGULATION_SYNTAX, what);
    }
    *value = strtol(word, &rest, 10);
    return *rest == '\0' || fail(reader, GM_TRIANGULATION_SYNTAX, what);
}

/* One that takes 8 bytes there: tags of nodes and elements. */
static bool take_tag(struct reader *reader, long *value, const char *what)
{
    int64_t number = 0;
    if (!reader->raw || reader->old) {
        return take_whole(reader, value, what);
    }
    const bool good = take_raw(reader, &number, sizeof number);
    *value = (long)number;
    const int64_t largest = 1000000000000000000;
    return good && ((number < largest && number > -largest) || fail(reader, GM_TRIANGULATION_SYNTAX, what));
}

/* A count of things that each need at least two bytes of the text that is left. */
static bool take_count(struct reader *reader, long *value, const char *what)
{
    if (!take_tag(reader, value, what)) {
        return false;
    }
    if (*value < 0) {
        return fail(reader, GM_TRIANGULATION_SYNTAX, what);
    }
    if (*value > MOST) {
        return fail(reader, GM_TRIANGULATION_HUGE, what);
    }
    if (*value > (reader->end - reader->at) / 2 + 1) {
        return fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
    }
    return true;
}

/* "$EndNodes" after the section "$Nodes" */
static bool expect_end(struct reader *reader)
{
    char wanted[44], word[44];
    reader->raw = false;
    snprintf(wanted, sizeof wanted, "$End%s", reader->section + 1);
    if (at_end(reader)) {
        return fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
    }
    return (take_word(reader, word, sizeof word) && strcmp(word, wanted) == 0) ||
           fail(reader, GM_TRIANGULATION_SYNTAX, wanted);
}

/* The sections, as tables. */

/* types of elements */
enum { LINE = 1, TRIANGLE = 2, LINE_OF_3 = 8, TRIANGLE_OF_6 = 9, POINT = 15 };

/* What follows the line's end is binary, if the file is. */
static void begin_raw(struct reader *reader)
{
    while (reader->binary && reader->at < reader->end && *reader->at++ != '\n') {
    }
    reader->raw = reader->binary;
}

static bool read_format(struct reader *reader)
{
    char version[16];
    long binary = 0, size = 0, one = 1;
    if (!take_word(reader, version, sizeof version)) {
        return fail(reader, GM_TRIANGULATION_SYNTAX, "a version");
    }
    reader->old = strcmp(version, "2.2") == 0;
    if (!reader->old && strcmp(version, "4.1") != 0) {
        return fail(reader, GM_TRIANGULATION_VERSION, version);
    }
    if (!take_whole(reader, &binary, "0 for ASCII, 1 for binary") || !take_whole(reader, &size, "a size")) {
        return false;
    }
    if (binary < 0 || binary > 1 || size != 8) {
        return fail(reader, GM_TRIANGULATION_SYNTAX,
                    "0 for ASCII or 1 for binary, and 8 for the size of numbers");
    }
    reader->binary = binary == 1;
    begin_raw(reader);
    if (reader->raw && !take_whole(reader, &one, "1")) {
        return false;
    }
    return one == 1 || fail(reader, GM_TRIANGULATION_BYTES, "");
}

static bool read_names(struct reader *reader)
{
    long count = 0;
    if (reader->groups || !take_count(reader, &count, "the number of names")) {
        return reader->groups ? fail(reader, GM_TRIANGULATION_SYNTAX, "one section $PhysicalNames") : false;
    }
    reader->groups = calloc((size_t)count + 1, sizeof *reader->groups);
    if (!reader->groups) {
        return fail(reader, GM_TRIANGULATION_MEMORY, "");
    }
    for (long i = 0; i < count; i++) {
        long dimension = 0, tag = 0;
        if (!take_whole(reader, &dimension, "a dimension") || !take_whole(reader, &tag, "a tag")) {
            return false;
        }
        skip_blanks(reader);
        if (reader->at >= reader->end || *reader->at != '"') {
            return fail(reader, GM_TRIANGULATION_SYNTAX, "a name in quotation marks");
        }
        const char *name = ++reader->at;
        while (reader->at < reader->end && *reader->at != '"' && *reader->at != '\n') {
            reader->at++;
        }
        const size_t length = (size_t)(reader->at - name);
        if (reader->at >= reader->end || *reader->at != '"' || length >= sizeof reader->groups->name) {
            return fail(reader, GM_TRIANGULATION_SYNTAX, "a name of at most 63 bytes in quotation marks");
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

static bool skip_numbers(struct reader *reader, long count)
{
    double value = 0;
    for (long i = 0; i < count; i++) {
        if (!take_number(reader, &value, "a number")) {
            return false;
        }
    }
    return true;
}

static bool add_curve(struct reader *reader, long tag, long physical)
{
    struct curve *more = realloc(reader->curves, (reader->curve_count + 1) * sizeof *more);
    if (!more) {
        return fail(reader, GM_TRIANGULATION_MEMORY, "");
    }
    reader->curves = more;
    more[reader->curve_count++] = (struct curve){tag, labs(physical)}; /* the sign is an orientation */
    return true;
}

/* What a part of an entity is of, in which parts of the mesh; a part of a curve is in its groups, too. */
static bool read_parent(struct reader *reader, long tag, int dimension)
{
    long whole = 0, parent = 0, count = 0, part = 0;
    bool good = take_whole(reader, &whole, "a dimension") && take_whole(reader, &parent, "an entity's tag") &&
                take_count(reader, &count, "a number of parts");
    for (long i = 0; good && i < count; i++) {
        good = take_whole(reader, &part, "a part");
    }
    const size_t known = reader->curve_count;
    for (size_t i = 0; good && dimension == 1 && whole == 1 && i < known; i++) {
        good = reader->curves[i].tag != parent || tag == parent ||
               add_curve(reader, tag, reader->curves[i].physical);
    }
    return good;
}

/* tag, of a part its whole, bounding box, physical tags and, from curves on, bounding entities */
static bool read_entity(struct reader *reader, int dimension, bool partitioned)
{
    long tag = 0, count = 0, physical = 0, bound = 0;
    if (!take_whole(reader, &tag, "an entity's tag") ||
        (partitioned && !read_parent(reader, tag, dimension)) ||
        !skip_numbers(reader, dimension == 0 ? 3 : 6) ||
        !take_count(reader, &count, "the number of physical tags")) {
        return false;
    }
    for (long i = 0; i < count; i++) {
        if (!take_whole(reader, &physical, "a physical tag") ||
            (dimension == 1 && labs(physical) < MOST && !add_curve(reader, tag, physical))) {
            return false;
        }
    }
    long bounds = 0;
    if (dimension == 0) {
        return true;
    }
    bool good = take_count(reader, &bounds, "a number of entities");
    for (long i = 0; good && i < bounds; i++) {
        good = take_whole(reader, &bound, "an entity's tag");
    }
    return good;
}

static bool read_all_entities(struct reader *reader, bool partitioned)
{
    long counts[4];
    for (int i = 0; i < 4; i++) {
        if (!take_count(reader, &counts[i], "a number of entities")) {
            return false;
        }
    }
    for (int dimension = 0; dimension < 4; dimension++) {
        for (long i = 0; i < counts[dimension]; i++) {
            if (!read_entity(reader, dimension, partitioned)) {
                return false;
            }
        }
    }
    return true;
}

static bool read_entities(struct reader *reader)
{
    if (reader->entities) {
        return fail(reader, GM_TRIANGULATION_SYNTAX, "one section $Entities");
    }
    reader->entities = true;
    begin_raw(reader);
    return read_all_entities(reader, false);
}

/* The same of a mesh in parts, which is one here; ghosts are elements of neighbours. */
static bool read_partitioned_entities(struct reader *reader)
{
    long parts = 0, ghosts = 0, tag = 0;
    begin_raw(reader);
    if (!take_count(reader, &parts, "a number of parts") ||
        !take_count(reader, &ghosts, "a number of ghosts")) {
        return false;
    }
    for (long i = 0; i < ghosts; i++) {
        if (!take_whole(reader, &tag, "a ghost's tag") || !take_whole(reader, &tag, "a part")) {
            return false;
        }
    }
    return read_all_entities(reader, true);
}

static int compare_nodes(const void *a, const void *b)
{
    const struct node *p = a, *q = b;
    return (p->tag > q->tag) - (p->tag < q->tag);
}

static bool read_node_block(struct reader *reader, size_t total)
{
    long dimension = 0, entity = 0, parametric = 0, count = 0;
    if (!take_whole(reader, &dimension, "a dimension") || !take_whole(reader, &entity, "an entity") ||
        !take_whole(reader, &parametric, "0 or 1") || !take_count(reader, &count, "a number of nodes")) {
        return false;
    }
    if (parametric < 0 || parametric > 1 || dimension < 0 || dimension > 3) {
        return fail(reader, GM_TRIANGULATION_SYNTAX, "a dimension, an entity, 0 or 1, and a number of nodes");
    }
    if ((size_t)count > total - reader->node_count) {
        return fail(reader, GM_TRIANGULATION_SYNTAX, "as many nodes as announced");
    }
    struct node *nodes = reader->nodes + reader->node_count;
    for (long i = 0; i < count; i++) {
        if (!take_tag(reader, &nodes[i].tag, "a node's tag")) {
            return false;
        }
        nodes[i].line = reader->line;
    }
    for (long i = 0; i < count; i++) {
        if (!take_number(reader, &nodes[i].x, "a coordinate") ||
            !take_number(reader, &nodes[i].y, "a coordinate") ||
            !take_number(reader, &nodes[i].z, "a coordinate") ||
            !skip_numbers(reader, parametric ? dimension : 0)) {
            return false;
        }
    }
    reader->node_count += (size_t)count;
    return true;
}

/* Behind a node of version 2.2 that has parameters: the dimension and the tag of what it lies on, and they. */
static bool skip_parameters(struct reader *reader)
{
    long dimension = 0, tag = 0;
    if (!reader->parametric) {
        return true;
    }
    return take_whole(reader, &dimension, "a dimension") && take_whole(reader, &tag, "a tag") &&
           skip_numbers(reader, dimension == 1 || dimension == 2 ? dimension : 0);
}

/* The nodes of version 2.2: each with its tag. */
static bool read_old_nodes(struct reader *reader, size_t total)
{
    begin_raw(reader);
    for (; reader->node_count < total; reader->node_count++) {
        struct node *node = &reader->nodes[reader->node_count];
        if (!take_whole(reader, &node->tag, "a node's tag")) {
            return false;
        }
        node->line = reader->line;
        if (!take_number(reader, &node->x, "a coordinate") ||
            !take_number(reader, &node->y, "a coordinate") ||
            !take_number(reader, &node->z, "a coordinate") || !skip_parameters(reader)) {
            return false;
        }
    }
    return true;
}

/* What sections begin with: the numbers of blocks, but in 2.2, and of things, and the range of their tags. */
static bool begin_blocks(struct reader *reader, long *blocks, long *total, const char *what)
{
    long low = 0, high = 0;
    if (reader->old) {
        return take_count(reader, total, what);
    }
    begin_raw(reader);
    return take_count(reader, blocks, "a number of blocks") && take_count(reader, total, what) &&
           take_tag(reader, &low, "a tag") && take_tag(reader, &high, "a tag");
}

static bool read_nodes(struct reader *reader)
{
    long blocks = 0, total = 0;
    if (!begin_blocks(reader, &blocks, &total, "a number of nodes")) {
        return false;
    }
    if (reader->nodes) {
        return fail(reader, GM_TRIANGULATION_SYNTAX, "one section $Nodes");
    }
    reader->nodes = calloc((size_t)total + 1, sizeof *reader->nodes);
    if (!reader->nodes) {
        return fail(reader, GM_TRIANGULATION_MEMORY, "");
    }
    if (reader->old && !read_old_nodes(reader, (size_t)total)) {
        return false;
    }
    for (long i = 0; i < blocks; i++) {
        if (!read_node_block(reader, (size_t)total)) {
            return false;
        }
    }
    if (reader->node_count != (size_t)total) {
        return fail(reader, GM_TRIANGULATION_SYNTAX, "as many nodes as announced");
    }
    qsort(reader->nodes, reader->node_count, sizeof *reader->nodes, compare_nodes);
    for (size_t i = 1; i < reader->node_count; i++) {
        if (reader->nodes[i].tag == reader->nodes[i - 1].tag) {
            const long a = reader->nodes[i].line, b = reader->nodes[i - 1].line;
            return fail_at_node(reader, GM_TRIANGULATION_REPEATED_NODE, a > b ? a : b, reader->nodes[i].tag);
        }
    }
    return true;
}

static bool read_parametric_nodes(struct reader *reader)
{
    reader->parametric = true;
    return read_nodes(reader);
}

static int nodes_of(long type)
{
    static const struct {
        long type;
        int nodes;
    } known[] = {{POINT, 1}, {LINE, 2}, {TRIANGLE, 3}, {LINE_OF_3, 3}, {TRIANGLE_OF_6, 6}};
    for (size_t i = 0; i < GM_COUNT(known); i++) {
        if (known[i].type == type) {
            return known[i].nodes;
        }
    }
    return 0;
}

/* The nodes of an element, whose tag and further tags are read: the corners come first, and those on sides that may be
   curved are passed over. */
static bool read_corners(struct reader *reader, long type, struct element element)
{
    for (int k = 0; k < nodes_of(type); k++) {
        long tag = 0;
        if (!take_tag(reader, k < 3 ? &element.nodes[k] : &tag, "a node's tag")) {
            return false;
        }
        if (!reader->raw && reader->line != element.line) {
            return fail(reader, GM_TRIANGULATION_SYNTAX, "the nodes of an element on its line");
        }
    }
    if (type == TRIANGLE || type == TRIANGLE_OF_6) {
        reader->triangles[reader->triangle_count++] = element;
    } else if (type == LINE || type == LINE_OF_3) {
        reader->lines[reader->line_count++] = element;
    }
    return true;
}

static bool read_element_block(struct reader *reader, size_t total, size_t *done)
{
    long dimension = 0, entity = 0, type = 0, count = 0, tag = 0;
    if (!take_whole(reader, &dimension, "a dimension") || !take_whole(reader, &entity, "an entity") ||
        !take_whole(reader, &type, "a type of elements") ||
        !take_count(reader, &count, "a number of elements")) {
        return false;
    }
    if (nodes_of(type) == 0) {
        return fail_at_node(reader, GM_TRIANGULATION_ELEMENT, reader->line, type);
    }
    if ((size_t)count > total - *done) {
        return fail(reader, GM_TRIANGULATION_SYNTAX, "as many elements as announced");
    }
    *done += (size_t)count;
    for (long i = 0; i < count; i++) {
        if (!take_tag(reader, &tag, "an element's tag") ||
            !read_corners(reader, type, (struct element){.line = reader->line, .entity = entity})) {
            return false;
        }
    }
    return true;
}

/* Elements of version 2.2: tag, type, number of tags, those (the first is the physical one) and nodes. In
   binary files type and numbers, of elements and of tags, stand before the elements that they hold for. */
static bool read_old_elements(struct reader *reader, size_t total, size_t *done)
{
    long type = 0, count = 1, tags = 0, tag = 0;
    if (reader->raw && (!take_whole(reader, &type, "a type of elements") ||
                        !take_whole(reader, &count, "a number of elements") ||
                        !take_whole(reader, &tags, "a number of tags"))) {
        return false;
    }
    if (count < 1 || (size_t)count > total - *done) {
        return fail(reader, GM_TRIANGULATION_SYNTAX, "as many elements as announced");
    }
    *done += (size_t)count;
    for (long i = 0; i < count; i++) {
        if (!take_whole(reader, &tag, "an element's tag")) {
            return false;
        }
        struct element element = {.line = reader->line};
        if (!reader->raw && (!take_whole(reader, &type, "a type of elements") ||
                             !take_count(reader, &tags, "a number of tags"))) {
            return false;
        }
        if (nodes_of(type) == 0) {
            return fail_at_node(reader, GM_TRIANGULATION_ELEMENT, element.line, type);
        }
        for (long k = 0; k < tags; k++) {
            if (!take_whole(reader, &tag, "a tag")) {
                return false;
            }
            element.entity = k == 0 && labs(tag) < MOST ? labs(tag) : element.entity;
        }
        if (!read_corners(reader, type, element)) {
            return false;
        }
    }
    return true;
}

static bool read_elements(struct reader *reader)
{
    long blocks = 0, total = 0;
    if (!begin_blocks(reader, &blocks, &total, "a number of elements")) {
        return false;
    }
    if (reader->triangles) {
        return fail(reader, GM_TRIANGULATION_SYNTAX, "one section $Elements");
    }
    reader->triangles = calloc((size_t)total + 1, sizeof *reader->triangles);
    reader->lines = calloc((size_t)total + 1, sizeof *reader->lines);
    if (!reader->triangles || !reader->lines) {
        return fail(reader, GM_TRIANGULATION_MEMORY, "");
    }
    size_t done = 0;
    if (reader->old) {
        begin_raw(reader);
    }
    while (reader->old && done < (size_t)total) {
        if (!read_old_elements(reader, (size_t)total, &done)) {
            return false;
        }
    }
    for (long i = 0; i < blocks; i++) {
        if (!read_element_block(reader, (size_t)total, &done)) {
            return false;
        }
    }
    return done == (size_t)total || fail(reader, GM_TRIANGULATION_SYNTAX, "as many elements as announced");
}

static bool skip_section(struct reader *reader)
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
    return fail(reader, GM_TRIANGULATION_TRUNCATED, reader->section);
}

/* Reads the whole text into the tables; nodes in the order of their tags. */
static bool read_sections(struct reader *reader)
{
    static const struct {
        const char *name;
        bool (*read)(struct reader *);
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
        return fail(reader, GM_TRIANGULATION_NOT_GMSH, "");
    }
    reader->section = section;
    if (!read_format(reader) || !expect_end(reader)) {
        return false;
    }
    while (!at_end(reader)) {
        if (!take_word(reader, section, sizeof section) || section[0] != '$') {
            return fail(reader, GM_TRIANGULATION_SYNTAX, "a section, such as $Nodes");
        }
        bool met = false;
        for (size_t i = 0; i < GM_COUNT(known); i++) {
            if (strcmp(section, known[i].name) == 0) {
                met = true;
                if (!known[i].read(reader) || !expect_end(reader)) {
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

/* By tag; NULL if there is none. */
static struct node *find_node(const struct reader *reader, long tag)
{
    const struct node key = {.tag = tag};
    return reader->node_count == 0
               ? NULL
               : bsearch(&key, reader->nodes, reader->node_count, sizeof *reader->nodes, compare_nodes);
}

/* The mesh. */

/* A triangle's nodes, ascending, and where it stands. */
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

static void exchange_if_above(long *a, long *b)
{
    const long low = *a < *b ? *a : *b;
    *b = *a < *b ? *b : *a;
    *a = low;
}

/* Version 2.2 writes a triangle once for each of its physical surfaces, and a surface that was meshed twice is there
   twice in any: the first stays. */
static bool drop_repeated(struct reader *reader)
{
    struct corners *all = malloc((reader->triangle_count + 1) * sizeof *all);
    if (!all) {
        return fail(reader, GM_TRIANGULATION_MEMORY, "");
    }
    for (size_t t = 0; t < reader->triangle_count; t++) {
        long *nodes = all[t].nodes;
        memcpy(nodes, reader->triangles[t].nodes, sizeof all[t].nodes);
        exchange_if_above(&nodes[0], &nodes[1]);
        exchange_if_above(&nodes[1], &nodes[2]);
        exchange_if_above(&nodes[0], &nodes[1]);
        all[t].place = t;
    }
    qsort(all, reader->triangle_count, sizeof *all, compare_corners);
    for (size_t t = 1; t < reader->triangle_count; t++) {
        if (memcmp(all[t].nodes, all[t - 1].nodes, sizeof all[t].nodes) == 0) {
            reader->triangles[all[t].place].line = -1;
        }
    }
    free(all);
    size_t count = 0;
    for (size_t t = 0; t < reader->triangle_count; t++) {
        reader->triangles[count] = reader->triangles[t];
        count += reader->triangles[t].line >= 0;
    }
    reader->origin.repeated = reader->old ? 0 : reader->triangle_count - count;
    reader->triangle_count = count;
    return true;
}

/* The sum of the triangles' normals, each as long as twice its triangle is large. */
static void add_normals(const struct reader *reader, double normal[3])
{
    for (size_t t = 0; t < reader->triangle_count; t++) {
        const struct node *node[3];
        for (int k = 0; k < 3; k++) {
            node[k] = find_node(reader, reader->triangles[t].nodes[k]);
        }
        const double a[3] = {node[1]->x - node[0]->x, node[1]->y - node[0]->y, node[1]->z - node[0]->z},
                     b[3] = {node[2]->x - node[0]->x, node[2]->y - node[0]->y, node[2]->z - node[0]->z};
        for (int k = 0; k < 3; k++) {
            const int next = (k + 1) % 3, last = (k + 2) % 3;
            normal[k] += a[next] * b[last] - a[last] * b[next];
        }
    }
}

/* Axes of the plane of the triangles: the first is the coordinate axis with the largest projection on it; seen
   so that triangles turn left. That of x and y where z is the same everywhere. */
static void choose_axes(struct reader *reader)
{
    double normal[3] = {0}, (*axes)[3] = reader->origin.axes;
    add_normals(reader, normal);
    const double size = hypot(hypot(normal[0], normal[1]), normal[2]);
    int first = 0;
    for (int k = 0; k < 3; k++) {
        normal[k] /= size > 0 ? size : 1;
        first = fabs(normal[k]) < fabs(normal[first]) ? k : first;
    }
    const double rest = sqrt(1 - normal[first] * normal[first]);
    for (int k = 0; k < 3; k++) {
        axes[0][k] = ((k == first) - normal[first] * normal[k]) / rest;
    }
    for (int k = 0; k < 3; k++) {
        const int next = (k + 1) % 3, last = (k + 2) % 3;
        axes[1][k] = normal[next] * axes[0][last] - normal[last] * axes[0][next];
    }
}

/* Takes the nodes of triangles into the plane where they lie: x and y are their places there. */
static bool lay_flat(struct reader *reader)
{
    const struct node *origin = NULL;
    double(*axes)[3] = reader->origin.axes, low[3] = {0}, high[3] = {0}, extent = 0;
    for (size_t i = 0; i < reader->node_count; i++) {
        const struct node *node = &reader->nodes[i];
        const double at[3] = {node->x, node->y, node->z};
        for (int k = 0; k < 3 && node->vertex >= 0; k++) {
            low[k] = origin ? fmin(low[k], at[k]) : at[k];
            high[k] = origin ? fmax(high[k], at[k]) : at[k];
            extent = fmax(extent, high[k] - low[k]);
        }
        origin = node->vertex >= 0 && !origin ? node : origin;
    }
    if (high[2] - low[2] <= 1e-9 * extent) {
        return true;
    }
    choose_axes(reader);
    const struct node from = *origin;
    for (size_t i = 0; i < reader->node_count; i++) {
        struct node *node = &reader->nodes[i];
        const double at[3] = {node->x - from.x, node->y - from.y, node->z - from.z};
        double place[2] = {0}, off = 0;
        for (int k = 0; k < 3; k++) {
            place[0] += axes[0][k] * at[k];
            place[1] += axes[1][k] * at[k];
        }
        for (int k = 0; k < 3; k++) {
            off = fmax(off, fabs(at[k] - place[0] * axes[0][k] - place[1] * axes[1][k]));
        }
        if (node->vertex >= 0 && !(off <= 1e-9 * extent)) {
            return fail_at_node(reader, GM_TRIANGULATION_THREE_D, node->line, node->tag);
        }
        node->x = place[0] + axes[0][0] * from.x + axes[0][1] * from.y + axes[0][2] * from.z;
        node->y = place[1] + axes[1][0] * from.x + axes[1][1] * from.y + axes[1][2] * from.z;
    }
    return true;
}

/* Numbers the nodes of triangles in the order of their tags; writes points, tags and corners. */
static bool number_nodes(struct reader *reader, double *points, long *tags, int *corners, size_t *vertices)
{
    for (size_t i = 0; i < reader->node_count; i++) {
        reader->nodes[i].vertex = -1;
    }
    for (size_t t = 0; t < reader->triangle_count; t++) {
        const struct element *element = &reader->triangles[t];
        for (int k = 0; k < 3; k++) {
            struct node *node = find_node(reader, element->nodes[k]);
            if (!node) {
                return fail_at_node(reader, GM_TRIANGULATION_UNKNOWN_NODE, element->line, element->nodes[k]);
            }
            node->vertex = 0;
        }
    }
    if (!lay_flat(reader)) {
        return false;
    }
    for (size_t i = 0; i < reader->node_count; i++) {
        struct node *node = &reader->nodes[i];
        if (node->vertex >= 0) {
            points[2 * *vertices] = node->x;
            points[2 * *vertices + 1] = node->y;
            tags[*vertices] = node->tag;
            node->vertex = (int)(*vertices)++;
        }
    }
    for (size_t t = 0; t < reader->triangle_count; t++) {
        for (size_t k = 0; k < 3; k++) {
            corners[3 * t + k] = find_node(reader, reader->triangles[t].nodes[k])->vertex;
        }
    }
    return true;
}

static int compare_curves(const void *a, const void *b)
{
    const struct curve *p = a, *q = b;
    return p->tag != q->tag ? (p->tag > q->tag) - (p->tag < q->tag)
                            : (p->physical > q->physical) - (p->physical < q->physical);
}

/* Puts an edge into all groups of its curve. */
static bool add_groups_of(const struct reader *reader, long entity, size_t edge,
                          struct gm_triangulation *mesh)
{
    size_t low = 0, high = reader->curve_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        low = reader->curves[middle].tag < entity ? middle + 1 : low;
        high = reader->curves[middle].tag < entity ? high : middle;
    }
    bool good = true;
    for (; good && low < reader->curve_count && reader->curves[low].tag == entity; low++) {
        good = gm_triangulation_add(mesh, edge, (int)reader->curves[low].physical);
    }
    return good;
}

static int find_edge(const struct gm_complex *complex, int a, int b)
{
    for (int k = complex->ring_start[a]; k < complex->ring_start[a + 1]; k++) {
        if (complex->ring_vertex[k] == b) {
            return complex->ring_edge[k];
        }
    }
    return -1;
}

static bool add_group(struct reader *reader, long tag)
{
    for (size_t i = 0; i < reader->group_count; i++) {
        if (reader->groups[i].tag == tag) {
            return true;
        }
    }
    struct gm_triangulation_group *more = realloc(reader->groups, (reader->group_count + 1) * sizeof *more);
    if (!more) {
        return fail(reader, GM_TRIANGULATION_MEMORY, "");
    }
    reader->groups = more;
    more[reader->group_count].tag = tag;
    snprintf(more[reader->group_count++].name, sizeof more->name, "%ld", tag);
    return true;
}

/* Groups of edges that have no name are named by their number. */
static bool number_groups(struct reader *reader, const struct gm_triangulation *mesh)
{
    bool good = true;
    int last = 0;
    for (size_t e = 0; good && e < mesh->complex->edges; e++) {
        good =
            mesh->edge_group[e] == 0 || mesh->edge_group[e] == last || add_group(reader, mesh->edge_group[e]);
        last = mesh->edge_group[e];
    }
    for (size_t i = 0; good && i < mesh->more_count; i++) {
        good = mesh->more[i].tag == last || add_group(reader, mesh->more[i].tag);
        last = mesh->more[i].tag;
    }
    return good;
}

/* Lines that are no edge of a triangle name nothing. */
static bool name_edges(struct reader *reader, struct gm_triangulation *mesh)
{
    if (reader->curve_count > 0) {
        qsort(reader->curves, reader->curve_count, sizeof *reader->curves, compare_curves);
    }
    for (size_t i = 0; i < reader->line_count; i++) {
        const struct element *element = &reader->lines[i];
        const struct node *a = find_node(reader, element->nodes[0]),
                          *b = find_node(reader, element->nodes[1]);
        if (!a || !b) {
            return fail_at_node(reader, GM_TRIANGULATION_UNKNOWN_NODE, element->line,
                                element->nodes[a ? 1 : 0]);
        }
        const int e = a->vertex >= 0 && b->vertex >= 0 ? find_edge(mesh->complex, a->vertex, b->vertex) : -1;
        const bool good = e < 0 || (reader->old ? gm_triangulation_add(mesh, (size_t)e, (int)element->entity)
                                                : add_groups_of(reader, element->entity, (size_t)e, mesh));
        if (!good) {
            return fail(reader, GM_TRIANGULATION_MEMORY, "");
        }
    }
    gm_triangulation_sort(mesh);
    return number_groups(reader, mesh);
}

static bool assemble(struct reader *reader, enum gm_star star, struct gm_triangulation *mesh)
{
    if (reader->triangle_count == 0) {
        return fail(reader, GM_TRIANGULATION_EMPTY, "");
    }
    if (!drop_repeated(reader)) {
        return false;
    }
    double *points = malloc(2 * (reader->node_count + 1) * sizeof *points);
    int *corners = malloc(3 * reader->triangle_count * sizeof *corners);
    mesh->tags = malloc((reader->node_count + 1) * sizeof *mesh->tags);
    size_t vertices = 0;
    bool good = points && corners && mesh->tags;
    if (!good) {
        fail(reader, GM_TRIANGULATION_MEMORY, "");
    }
    good = good && number_nodes(reader, points, mesh->tags, corners, &vertices);
    if (good) {
        mesh->complex = gm_complex_open(&(struct gm_triangles){.points = points,
                                                               .vertices = vertices,
                                                               .corners = corners,
                                                               .count = reader->triangle_count,
                                                               .star = star,
                                                               .tags = mesh->tags},
                                        reader->fault);
        good = mesh->complex != NULL;
        if (good) {
            mesh->complex->origin = reader->origin;
        }
        if (!good && reader->fault->triangle > 0 && !reader->binary) {
            reader->fault->line = reader->triangles[reader->fault->triangle - 1].line;
        }
    }
    free(points);
    free(corners);
    if (good) {
        mesh->edge_group = calloc(mesh->complex->edges, sizeof *mesh->edge_group);
        good = mesh->edge_group || fail(reader, GM_TRIANGULATION_MEMORY, "");
    }
    return good && name_edges(reader, mesh);
}

bool gm_triangulation_read(const char *text, size_t size, enum gm_star star, struct gm_triangulation *mesh,
                           struct gm_triangulation_fault *fault)
{
    struct reader reader = {.at = text, .end = text + size, .line = 1, .fault = fault, .section = ""};
    *mesh = (struct gm_triangulation){0};
    *fault = (struct gm_triangulation_fault){.kind = GM_TRIANGULATION_OK};
    const bool good = read_sections(&reader) && assemble(&reader, star, mesh);
    if (good) {
        mesh->group = reader.groups;
        mesh->groups = reader.group_count;
        reader.groups = NULL;
    } else {
        gm_triangulation_close(mesh);
    }
    free(reader.nodes);
    free(reader.triangles);
    free(reader.lines);
    free(reader.curves);
    free(reader.groups);
    return good;
}

void gm_triangulation_close(struct gm_triangulation *mesh)
{
    gm_complex_close(mesh->complex);
    free(mesh->tags);
    free(mesh->edge_group);
    free(mesh->more);
    free(mesh->group);
    *mesh = (struct gm_triangulation){0};
}

/* Where the further tags of an edge begin. */
static size_t first_of(const struct gm_triangulation *mesh, size_t edge)
{
    size_t low = 0, high = mesh->more_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        const bool before = mesh->more[middle].edge < (int)edge;
        low = before ? middle + 1 : low;
        high = before ? high : middle;
    }
    return low;
}

bool gm_triangulation_has(const struct gm_triangulation *mesh, size_t edge, long tag)
{
    bool has = mesh->edge_group[edge] == tag;
    for (size_t i = first_of(mesh, edge); i < mesh->more_count && mesh->more[i].edge == (int)edge; i++) {
        has |= mesh->more[i].tag == tag;
    }
    return has;
}

static int compare_members(const void *a, const void *b)
{
    const struct gm_triangulation_member *p = a, *q = b;
    return p->edge != q->edge ? (p->edge > q->edge) - (p->edge < q->edge)
                              : (p->tag > q->tag) - (p->tag < q->tag);
}

bool gm_triangulation_add(struct gm_triangulation *mesh, size_t edge, int tag)
{
    const size_t count = mesh->more_count;
    if (tag == 0 || mesh->edge_group[edge] == 0 || mesh->edge_group[edge] == tag) {
        mesh->edge_group[edge] = tag != 0 ? tag : mesh->edge_group[edge];
        return true;
    }
    if ((count & (count - 1)) == 0) { /* it is full: twice as many */
        struct gm_triangulation_member *more = realloc(mesh->more, (2 * count + 1) * sizeof *more);
        if (!more) {
            return false;
        }
        mesh->more = more;
    }
    mesh->more[mesh->more_count++] = (struct gm_triangulation_member){(int)edge, tag};
    return true;
}

void gm_triangulation_sort(struct gm_triangulation *mesh)
{
    if (mesh->more_count > 0) {
        qsort(mesh->more, mesh->more_count, sizeof *mesh->more, compare_members);
    }
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
    for (size_t e = 0; rest != name && *rest == '\0' && mesh->complex && e < mesh->complex->edges; e++) {
        if (tag != 0 && gm_triangulation_has(mesh, e, tag)) {
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
