/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The table of options, from which they are read, checked and explained. */
#include "app/commands/commands.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "app/words/system.h"
#include "app/words/words.h"
#include "core/basics.h"
#include "core/expression/nearest.h"
#include "core/memory.h"
#include "core/model/invariants.h"
#include "render/cells/text.h"
#include "render/files/sink.h"

enum kind {
    FLAG,
    TEXT,
    TITLE,
    FORMAT,
    MOVIE,
    WHOLE,
    DEGREE,
    TIME,
    RATE,
    FPS,
    SCALE,
    DPI,
    SIZE,
    CHOICE,
    SHARD,
    WORD
};

#define AT(member) offsetof(struct gm_options, member)
#define PAINTS (GM_CHARTS | GM_RENDER | GM_FIGURES | GM_TOUR)
#define PRINTS (GM_CHARTS | GM_RENDER | GM_AGAIN)
#define EXPLORES (GM_TUI | GM_TERMINAL | GM_TOUR)

const struct gm_option gm_option_rows[] = {
    {"--json", FLAG,
     GM_RUN | GM_LIST | GM_CERTIFY | GM_STABILITY | GM_BACKWARD | GM_WORK_PRECISION | GM_ORBIT | GM_FIGURES,
     AT(json), "", "one JSON object per line"},
    {"--long", FLAG, GM_LIST, AT(longer), "", "with formulas and references"},
    {"--markdown", FLAG, GM_LIST, AT(markdown), "", "scenes or schemes as in the documentation"},
    {"--latex", FLAG, GM_LIST, AT(latex), "", "the equations of a system, for a paper"},
    {"--invariants", FLAG, GM_LIST, AT(invariants), "", "find the invariants of a system, and prove them"},
    {"--degree", DEGREE, GM_LIST, AT(degree), "D", "their largest degree, 1 to 8 (4)"},
    {"--source", FLAG, GM_LIST, AT(source), "",
     "the text of a system's, a room's, a scheme's or a tour's file"},
    {"--state", FLAG, GM_RUN, AT(state), "", "with the final state (needs --json)"},
    {"--max", FLAG, GM_RUN, AT(maximum), "", "also NAME_max, the value of largest magnitude over all steps"},
    {"--csv", TEXT, GM_RUN, AT(csv), "FILE", "write the history to FILE"},
    {"--profile", TEXT, GM_RUN, AT(profile), "FILE", "write profiles of the final state to FILE"},
    {"--every", WHOLE, GM_RUN | GM_RENDER, AT(pace.every), "K",
     "run: a row of --csv and --save, render: a frame, every K steps"},
    {"--interval", RATE, GM_RUN, AT(interval), "T",
     "a row at the steps next to multiples of T in model time"},
    {"--save", TEXT, GM_RUN, AT(save), "FILE", "write the states to FILE: .npz, .csv, .pvd or .xdmf"},
    {"--save", TEXT, GM_ORBIT, AT(save), "FILE.system",
     "write the system with the start and the period of the orbit"},
    {"--save-tracks", TEXT, GM_RUN, AT(tracks), "FILE", "write trails, sections ... to FILE.npz"},
    {"--checkpoint", TEXT, GM_RUN, AT(checkpoint), "FILE",
     "write the state to FILE, from which --continue resumes"},
    {"--continue", TEXT, GM_RUN, AT(from_checkpoint), "FILE", "resume from a checkpoint"},
    {"--frames", WHOLE, GM_RENDER, AT(pace.frames), "N", "N frames, evenly spaced in model time"},
    {"--fps", FPS, GM_RENDER | GM_TOUR, AT(pace.fps), "F", "frames per second of the movie (30)"},
    {"--rate", RATE, GM_RENDER, AT(pace.rate), "R", "model time per second of the movie"},
    {"--from", TIME, GM_RENDER, AT(pace.from), "T", "first frame at model time T"},
    {"--at", TIME, GM_RENDER, AT(pace.at), "T", "one picture at model time T"},
    {"--output", TEXT, PRINTS, AT(output), "FILE",
     "one picture to FILE (-o): .png, .svg or .pdf; - is standard output"},
    {"--format", FORMAT, PRINTS | GM_FIGURES, AT(format_name), "png|svg|pdf",
     "format of pictures whose names have no ending (png)"},
    {"--painter", TEXT, GM_PAINTS, AT(painter), "auto|osmesa|egl|own",
     "what paints pixels: OSMesa if it is installed, own in the terminal (auto)"},
    {"--output", TEXT, GM_WEB, AT(lesson), "FILE.html", "write the page to FILE.html (-o lesson.html)"},
    {"--tour", TEXT, GM_WEB, AT(tour), "NAME|FILE.tour", "a lesson in steps instead of one view"},
    {"--title", TITLE, (PAINTS & ~(unsigned)(GM_FIGURES | GM_TOUR)) | GM_WEB, AT(look.title), "TEXT",
     "title of the picture or the page"},
    {"--size", SIZE, PAINTS, AT(look.width), "WxH", "pixels (1280x720), or lengths: 16x9cm, 160x90mm"},
    {"--dpi", DPI, PAINTS, AT(look.dpi), "N", "pixels per inch (96; 300 for a size in lengths)"},
    {"--scale", SCALE, PAINTS, AT(look.scale), "S", "letters and lines S times as large (1)"},
    {"--theme", CHOICE, PAINTS & ~(unsigned)(GM_FIGURES | GM_TOUR), AT(look.theme), "light|dark",
     "colours for paper or for a screen"},
    {"--changes", TEXT, GM_RENDER, AT(changes), "LIST",
     "LANE:STEP:KEY=VALUE,...: changes during the run (key y)"},
    {"--window", WORD, GM_RUN | GM_RENDER | GM_TUI, 0, "XMIN,XMAX,YMIN,YMAX",
     "the plane that is shown, and searched by portrait=yes"},
    {"--graphics", TEXT, EXPLORES, AT(terminal.graphics), "KIND",
     "kitty, sixel, braille, quadrants, half or ascii"},
    {"--colours", TEXT, EXPLORES, AT(terminal.colours), "HOWMANY", "truecolor, 256, 16 or none"},
    {"--shot", TEXT, GM_TUI | GM_TOUR, AT(terminal.shot), "FILE",
     "draw the screen into FILE, without a terminal: .txt, .svg or .png"},
    {"--screen", TEXT, GM_TUI | GM_TOUR, AT(terminal.screen), "COLUMNSxROWS",
     "size of the screen of --shot, 20x6 to 400x120 (80x24)"},
    {"--keys", TEXT, GM_TUI | GM_TOUR, AT(terminal.keys), "'WORD ...'",
     "keys before --shot: 2s lets 2 s pass, ENTER, ESC, UP ..., or text to type"},
    {"--theme", TEXT, EXPLORES, AT(terminal.theme), "THEME", "light, dark or, in a terminal, mono"},
    {"--out", TEXT, PAINTS | GM_AGAIN, AT(out), "DIR", "folder of the output (here)"},
    {"--movie", MOVIE, GM_RENDER | GM_TOUR, AT(pace.movie), "FILE", "write a movie: .mp4, .webm or .gif"},
    {"--table", TEXT, GM_SWEEP, AT(table), "FILE.csv",
     "write the rows to FILE.csv; the same command resumes"},
    {"--jobs", WHOLE, GM_SWEEP | GM_STABILITY | GM_BACKWARD, AT(jobs), "N", "N runs at once (one per core)"},
    {"--values", TEXT, GM_SWEEP, AT(values), "NAME:K",
     "rows and a picture of the last K values of a component or an observable"},
    {"--at", TEXT, GM_SWEEP, AT(place), "step|section|maximum",
     "the places of --values (section, if there is one; a map of dt = 1: step)"},
    {"--retry", TEXT, GM_SWEEP, AT(retry), "STATUS",
     "recompute the rows with this status, or with a warning"},
    {"--yes", FLAG, GM_RUN | GM_RENDER | (GM_CHARTS & ~(unsigned)(GM_CERTIFY | GM_ORBIT)), AT(yes), "",
     "also with more than a million runs or 1e11 steps"},
    {"--join", TEXT, GM_SWEEP, AT(join), "FILE.csv", "join the shards' tables, and list the missing rows"},
    {"--shard", SHARD, GM_RENDER, AT(pace.shard), "I/N", "only the I-th of N shards of the frames"},
    {"--shard", SHARD, GM_SWEEP, AT(pace.shard), "I/N",
     "only the I-th of N shards of the runs, in its own table"},
    {"--engine", CHOICE, GM_TUI | GM_RUN | GM_RENDER | GM_SWEEP | GM_WORK_PRECISION, AT(engine),
     "auto|interpreted|native", "what advances user-defined systems (auto: compiled code, if it is faster)"},
    {"--clear", FLAG, GM_CACHE, AT(clear), "", "remove the compiled code"},
    {"--strict", FLAG, GM_RUN | GM_RENDER, AT(strict), "",
     "exit 2 if a lane ends in a numerical failure (run: or with a warning)"},
    {"--measure", TEXT, GM_WORK_PRECISION, AT(measure), "KEY", "the observable that is the error"},
    {"--measure", TEXT, GM_RUN, AT(measure), "KEY,...",
     "the printed observables (all except those computed on request)"},
    {"--measure", TEXT, GM_SWEEP, AT(measure), "KEY,...", "the observables of the table (all)"},
    {"--region", TEXT, GM_STABILITY, AT(region), "SCHEME",
     "the linear stability region of a scheme, no scene"},
    {"--judge", TEXT, GM_STABILITY, AT(judge), "bounded|accurate[=E]",
     "steps that stay bounded, or whose error is at most E (bounded; E = 0.1)"},
    {"--on", TEXT, GM_CERTIFY, AT(on), "SYSTEM",
     "measure on this system: a scene, a file, or system with formulas after the scheme"},
    {"--polish", TEXT, GM_CERTIFY, AT(polish), "OUT.scheme",
     "write the scheme with decimals that satisfy the order conditions"},
    {"--list", FLAG, GM_TOUR, AT(listing), "", "list the tours, or the steps of one"},
    {"--quick", FLAG, GM_FIGURES, AT(quick), "", "smaller pictures; long runs are coarser and not judged"},
};
enum { ROWS = GM_COUNT(gm_option_rows) };
const size_t gm_option_count = ROWS;

static bool refuse(char *message, const char *name, const char *value, const char *what)
{
    return gm_refuse(message, "%s %.60s%s%s", name, value, *value ? " " : "", what);
}

/* Stores a number of the option's kind; a range without an upper bound excludes its lower bound. */
static bool store_number(char *place, const struct gm_option *row, const char *value, char *message)
{
    static const double bounds[][2] = {[TIME] = {-INFINITY, INFINITY},
                                       [RATE] = {0, INFINITY},
                                       [FPS] = {0.01, 1000},
                                       [SCALE] = {GM_LEAST_SCALE, GM_MOST_SCALE},
                                       [DPI] = {GM_LEAST_DPI, GM_MOST_DPI},
                                       [WHOLE] = {1, 1e9},
                                       [DEGREE] = {1, GM_LARGEST_DEGREE}};
    const double low = bounds[row->kind][0], high = bounds[row->kind][1];
    const bool open = isinf(high), whole = row->kind == WHOLE || row->kind == DEGREE;
    double number = NAN;
    char what[64];
    if (!gm_number_parse(value, &number) || !isfinite(number) || number > high ||
        !(open ? number > low : number >= low) || (whole && number != floor(number))) {
        snprintf(what, sizeof what,
                 row->kind == DEGREE ? "is not a whole number from %g to %g"
                 : whole             ? "is not a whole number from 1 to 1e9"
                 : !open             ? "is not a number from %g to %g"
                 : isinf(low)        ? "is not a number"
                                     : "is not a number above 0",
                 low, high);
        return gm_memory_was_short() ? gm_refuse(message, "not enough memory")
                                     : refuse(message, row->name, value, what);
    }
    const long integer = whole ? (long)number : 0;
    memcpy(place, whole ? (const void *)&integer : &number, sizeof number);
    return true;
}

/* Stores the number of a value among those that the option has, "auto|interpreted|native". */
static bool store_choice(char *place, const struct gm_option *row, const char *value, char *message)
{
    int number = 0;
    char what[128] = "is none of: ";
    for (const char *word = row->value; *word; number++) {
        const size_t length = strcspn(word, "|");
        if (strlen(value) == length && strncmp(word, value, length) == 0) {
            memcpy(place, &number, sizeof number);
            return true;
        }
        gm_append(what, sizeof what, "%s%.*s", number > 0 ? ", " : "", (int)length, word);
        word += length + (word[length] == '|');
    }
    return refuse(message, row->name, value, what);
}

static bool read_shard(const char *value, struct gm_options *options)
{
    int used = 0;
    return sscanf(value, "%6ld/%6ld%n", &options->pace.shard, &options->pace.shards, &used) == 2 &&
           !value[used] && options->pace.shard >= 1 && options->pace.shard <= options->pace.shards;
}

static bool is_painted(double width, double height)
{
    return width >= GM_LEAST_SIDE && height >= GM_LEAST_SIDE && width <= GM_MOST_SIDE &&
           height <= GM_MOST_SIDE;
}

/* "1280x720", or "16x9cm", of which the pixels follow when --dpi is known: page[] then is in mm. */
static bool read_size(const char *value, double page[2], struct gm_appearance *look)
{
    int width = 0, height = 0, used = 0;
    char unit[3] = "", first[3] = "", more = '\0';
    if (sscanf(value, "%5dx%5d%n", &width, &height, &used) == 2 && !value[used]) {
        look->width = width;
        look->height = height;
        return is_painted(width, height);
    }
    if (strspn(value, "0123456789.xcm") != strlen(value) ||
        (sscanf(value, "%lfx%lf%2[cm]%c", &page[0], &page[1], unit, &more) != 3 &&
         (sscanf(value, "%lf%2[cm]x%lf%2[cm]%c", &page[0], first, &page[1], unit, &more) != 4 ||
          strcmp(first, unit) != 0))) {
        return false;
    }
    const double mm = strcmp(unit, "cm") == 0 ? 10 : strcmp(unit, "mm") == 0 ? 1 : NAN;
    page[0] *= mm;
    page[1] *= mm;
    return page[0] > 0 && page[1] > 0;
}

/* The pixels of a page in mm. */
static bool settle_size(struct gm_options *options, char *message)
{
    const double mm_an_inch = 25.4, print_dpi = 300;
    struct gm_appearance *look = &options->look;
    if (!(options->page[0] > 0)) {
        return true;
    }
    look->dpi = look->dpi > 0 ? look->dpi : print_dpi;
    const double width = round(options->page[0] / mm_an_inch * look->dpi);
    const double height = round(options->page[1] / mm_an_inch * look->dpi);
    if (!is_painted(width, height)) {
        return gm_refuse(message, "--size %gx%gmm is %gx%g pixels at %g dpi; each must be from 64 to 16384",
                         options->page[0], options->page[1], width, height, look->dpi);
    }
    look->width = (int)width;
    look->height = (int)height;
    look->page_width = options->page[0];
    look->page_height = options->page[1];
    return true;
}

/* The format of pictures, by the name of --output's file or by --format. */
static bool settle_format(struct gm_options *options, char *message)
{
    enum gm_format format = options->format;
    if (gm_options_take_stdout(options) && options->json) {
        return gm_refuse(message, "--output - and --json are both to write to standard output");
    }
    if (options->output && !gm_options_take_stdout(options) && !gm_format_of(options->output, &format)) {
        return refuse(message, "--output", options->output, "is no .png, .svg or .pdf file");
    }
    if (options->format_name && format != options->format) {
        return gm_refuse(message, "--output %.300s and --format %s name two formats", options->output,
                         options->format_name);
    }
    options->format = format;
    return format == GM_FORMAT_PNG || !options->painter || strcmp(options->painter, "auto") == 0 ||
           gm_refuse(message,
                     "--painter %.40s paints PNG files and movies; an SVG or PDF file is lines and letters",
                     options->painter);
}

static bool store(struct gm_options *options, const struct gm_option *row, const char *value, char *message)
{
    char *place = (char *)options + row->offset;
    const char *wrong = NULL;
    switch ((enum kind)row->kind) {
    case FLAG:
        memcpy(place, &(int){1}, sizeof(int));
        return true;
    case WHOLE:
    case DEGREE:
    case TIME:
    case RATE:
    case FPS:
    case SCALE:
    case DPI:
        return store_number(place, row, value, message);
    case SIZE:
        options->sized = true;
        return read_size(value, options->page, &options->look) ||
               refuse(message, row->name, value,
                      "is not WIDTHxHEIGHT, each of them from 64 to 16384 pixels, or in cm or mm: 16x9cm");
    case SHARD:
        return read_shard(value, options) ||
               refuse(message, row->name, value, "is not I/N, the I-th of N shards, with I from 1 to N");
    case CHOICE:
        return store_choice(place, row, value, message);
    case TITLE:
        wrong = gm_text_is_plain(value) ? NULL : "has characters that are not shown";
        value = wrong ? "" : value;
        break;
    case FORMAT:
        wrong = gm_format_find(value, &options->format) ? NULL : "is none of: png, svg, pdf";
        break;
    case MOVIE:
        wrong = gm_sink_is_movie(value) ? NULL : "is no .mp4, .webm or .gif file";
        break;
    case WORD:
        gm_arguments_print(&options->arguments, "%s=%s", row->name + strlen("--"), value);
        return true;
    case TEXT:
        break;
    }
    wrong = wrong || *value ? wrong : "is empty";
    if (wrong) {
        return refuse(message, row->name, value, wrong);
    }
    memcpy(place, &value, sizeof value);
    return true;
}

const struct gm_option *gm_option_find(const char *word, enum gm_command command)
{
    const struct gm_option *found = NULL;
    const size_t length = strcspn(word, "=");
    for (size_t i = 0; i < ROWS; i++) {
        if (strlen(gm_option_rows[i].name) == length && strncmp(gm_option_rows[i].name, word, length) == 0 &&
            (!found || gm_option_rows[i].commands & command)) {
            found = &gm_option_rows[i];
        }
    }
    return found;
}

/* The name without its dashes; "" if this command does not take it. */
static const char *name_at(size_t i, const void *data)
{
    const enum gm_command *command = data;
    return gm_option_rows[i].commands & *command ? gm_option_rows[i].name + strlen("--") : "";
}

/* Reports an unknown option, with the key=value or the option that was probably meant, or all options of the
   command. `next`: the word after it, or NULL. */
static void refuse_option(char *message, const char *word, const char *next, const struct gm_options *options,
                          enum gm_command command)
{
    char name[64], meant[128] = "";
    const size_t length = strcspn(word, "=");
    snprintf(name, sizeof name, "%.*s", (int)length, word);
    const bool elsewhere = gm_option_find(word, command);
    const struct gm_scene *scene =
        options->arguments.count > 0 ? gm_scene_called(options->arguments.words[0]) : NULL;
    if (scene && !elsewhere) {
        gm_words_assignment(scene, name + strlen("--"), word[length] ? word + length + 1 : next, meant,
                            sizeof meant);
    }
    const bool search = !elsewhere && !meant[0];
    const char *near = search ? gm_nearest(name + strlen("--"), ROWS, name_at, &command) : NULL;
    gm_refuse(message, "%s option %.60s%s%s%s", elsewhere ? "this command has no" : "there is no", name,
              meant, near ? "; did you mean --" : "", near ? near : "");
    const char *between = elsewhere ? "; it has " : "; there are ";
    for (size_t i = 0; i < ROWS && !near && !meant[0]; i++) {
        if (gm_option_rows[i].commands & command) {
            gm_append(message, GM_MESSAGE, "%s%s", between, gm_option_rows[i].name);
            between = ", ";
        }
    }
}

/* The folder of a path, and its name there; false: the folder is missing. */
static bool find_folder(const char *path, struct stat *folder, const char **name)
{
    char text[4096];
    *name = basename(path);
    snprintf(text, sizeof text, "%.*s.", (int)(*name - path), path);
    return stat(text, folder) == 0;
}

static bool are_one(const struct stat *a, const struct stat *b)
{
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino;
}

bool gm_command_same_file(const char *a, const char *b)
{
    struct stat x, y;
    const char *one, *other;
    const bool there = stat(a, &x) == 0;
    if (stat(b, &y) == 0 && there) {
        return S_ISREG(x.st_mode) && are_one(&x, &y);
    }
    return find_folder(a, &x, &one) && find_folder(b, &y, &other) && are_one(&x, &y) &&
           strcmp(one, other) == 0;
}

/* Returns true if no file is written twice or also read; `again` may overwrite its picture. */
static bool check_files(const struct gm_options *options, enum gm_command command, char *message)
{
    const struct {
        const char *name, *path;
    } files[] = {{"--csv", options->csv},
                 {"--profile", options->profile},
                 {"--save", options->save},
                 {"--save-tracks", options->tracks},
                 {"--table", options->table},
                 {"--output", options->output},
                 {"--output", options->lesson},
                 {"--movie", options->pace.movie},
                 {"--polish", options->polish},
                 {"--shot", options->terminal.shot},
                 {"--checkpoint", options->checkpoint}};
    enum { FILES = GM_COUNT(files), CHECKPOINT = FILES - 1 };
    for (size_t i = 0; i < FILES; i++) {
        if (!files[i].path || strcmp(files[i].path, "-") == 0) {
            continue;
        }
        for (size_t k = i + 1; k < FILES; k++) {
            if (files[k].path && gm_command_same_file(files[i].path, files[k].path)) {
                return gm_refuse(message, "%s and %s are to write to one file, %.300s", files[i].name,
                                 files[k].name, files[i].path);
            }
        }
        bool read = i != CHECKPOINT && options->from_checkpoint &&
                    gm_command_same_file(files[i].path, options->from_checkpoint);
        for (int k = 0; k < options->arguments.count && !read && command != GM_AGAIN; k++) {
            const char *word = options->arguments.words[k], *equals = strchr(word, '=');
            read = gm_command_same_file(files[i].path, word) ||
                   (equals && gm_command_same_file(files[i].path, equals + 1));
        }
        if (read) {
            return gm_refuse(message, "%s would overwrite %.300s, which is read", files[i].name,
                             files[i].path);
        }
    }
    return true;
}

static bool check_pairs(const struct gm_options *options, enum gm_command command, const bool given[ROWS],
                        char *message)
{
    static const struct {
        const char *one, *why, *others;
    } pairs[] = {
        {"--at", "the first makes one picture", "--frames --every --rate --fps --from --movie "},
        {"--frames", "each sets the number of frames", "--every --rate "},
        {"--every", "each sets the number of frames", "--rate "},
        {"--every", "each selects the steps that have a row", "--interval "},
        {"--output", "the first names the file", "--out "},
        {"--output", "the first makes one picture", "--frames --every --rate --fps --from --movie "},
        {"--json", "they are two formats", "--markdown --latex "},
        {"--invariants", "each is a list of its own", "--markdown --latex --source --long "},
        {"--latex", "they are two formats", "--markdown "},
        {"--list", "the first only lists steps", "--movie --out "},
        {"--join", "the first makes no run", "--table --shard --retry "},
        {"--region", "a region has no error", "--judge "},
        {"--join", "the tables have the columns that they have", "--measure --values --at "},
    };
    for (size_t i = 0; i < GM_COUNT(pairs); i++) {
        const struct gm_option *one = gm_option_find(pairs[i].one, command);
        for (const char *at = pairs[i].others; *at && given[one - gm_option_rows]; at = strchr(at, ' ') + 1) {
            char name[16];
            snprintf(name, sizeof name, "%.*s", (int)strcspn(at, " "), at);
            if (given[gm_option_find(name, command) - gm_option_rows]) {
                return gm_refuse(message, "%s and %s contradict each other: %s", pairs[i].one, name,
                                 pairs[i].why);
            }
        }
    }
    return check_files(options, command, message);
}

bool gm_options_parse(struct gm_options *options, enum gm_command command, int argc, char *argv[], int first,
                      char *message)
{
    *options = (struct gm_options){.pace = {.fps = NAN, .rate = NAN, .from = NAN, .at = NAN},
                                   .interval = NAN,
                                   .look = {.width = 1280, .height = 720}};
    bool given[ROWS] = {false};
    for (int i = first; i < argc; i++) {
        const char *word = gm_option_name(argv[i]);
        if (strncmp(word, "--", 2) != 0 ||
            command == GM_COMPLETE) { /* a word to complete may be an unfinished option */
            gm_arguments_add(&options->arguments, argv[i]);
            continue;
        }
        const char *equals = strchr(word, '=');
        const struct gm_option *row = gm_option_find(word, command);
        if (!row || !(row->commands & command)) {
            refuse_option(message, word, i + 1 < argc ? argv[i + 1] : NULL, options, command);
            return false;
        }
        const char *value = "";
        if (row->kind == FLAG && equals) {
            return gm_refuse(message, "%s takes no value", row->name);
        }
        if (row->kind != FLAG) {
            value = equals ? equals + 1 : i + 1 < argc ? argv[++i] : NULL;
            if (!value) {
                return gm_refuse(message, "%s needs a value: %s", row->name, row->value);
            }
        }
        if (given[row - gm_option_rows]) {
            return gm_refuse(message, "%s is given twice", row->name);
        }
        given[row - gm_option_rows] = true;
        if (!store(options, row, value, message)) {
            return false;
        }
    }
    return (!options->arguments.failed || gm_refuse(message, "not enough memory")) &&
           check_pairs(options, command, given, message) && settle_size(options, message) &&
           settle_format(options, message);
}

bool gm_options_take_stdout(const struct gm_options *options)
{
    return options->output && strcmp(options->output, "-") == 0;
}

void gm_options_close(void *self)
{
    gm_arguments_close(&((struct gm_options *)self)->arguments);
}

const char *gm_option_name(const char *word)
{
    return strcmp(word, "-o") == 0 ? "--output" : word;
}
