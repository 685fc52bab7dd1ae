/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The folder of compiled code: its owner, its checks, and its removal of old entries. */
#include "app/native/cache.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "render/message.h"

enum { MOST_ENTRIES = 256, LARGEST = 1 << 24, MOST_BYTES = 1 << 26 };
static const char ending[] = ".so";

/* The end of the file, after the library; loaders ignore it. */
struct seal {
    char magic[8];
    uint64_t a, b;
};
static const char magic[8] = {'g', 'e', 'o', 'm', 'i', 'n', 't', '1'};

struct gm_cache_key gm_digest_key(const struct gm_digest *digest)
{
    struct gm_cache_key key;
    snprintf(key.text, sizeof key.text, "%016llx%016llx", (unsigned long long)digest->a,
             (unsigned long long)digest->b);
    return key;
}

bool gm_cache_folder(char path[GM_CACHE_PATH], char *sentence)
{
    const char *own = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    const bool known = own && own[0] == '/';
    struct stat about;
    if (!known && !(home && home[0] == '/')) {
        return gm_refuse(sentence, "there is no folder for caches: neither XDG_CACHE_HOME nor HOME is set");
    }
    /* longer paths have no room for an entry's name */
    if (snprintf(path, GM_CACHE_PATH - 128, "%s%s", known ? own : home, known ? "" : "/.cache") >=
        GM_CACHE_PATH - 128) {
        return gm_refuse(sentence, "the path of the cache is too long");
    }
    mkdir(path, 0700);
    strcat(path, "/geomint");
    if ((mkdir(path, 0700) != 0 && errno != EEXIST) || lstat(path, &about) != 0) {
        return gm_refuse(sentence, "%.200s could not be made: %s", path, strerror(errno));
    }
    if (!S_ISDIR(about.st_mode) || about.st_uid != geteuid() || (about.st_mode & 077) != 0) {
        return gm_refuse(sentence, "%.200s is not used: it must be a folder that only you may open", path);
    }
    return true;
}

static void path_of(const char *folder, const struct gm_cache_key *key, char path[GM_CACHE_PATH])
{
    snprintf(path, GM_CACHE_PATH, "%.3900s/%s%s", folder, key->text, ending);
}

/* The digest of a file's bytes except the last `without`, which go to `last`; false if the file is not
   regular, or another user's. */
static bool digest_file(int file, size_t without, struct gm_digest *digest, struct seal *last)
{
    struct stat about;
    char bytes[1 << 14];
    *digest = gm_digest_open();
    if (fstat(file, &about) != 0 || !S_ISREG(about.st_mode) || about.st_uid != geteuid() ||
        about.st_size > LARGEST || (size_t)about.st_size <= without) {
        return false;
    }
    for (size_t left = (size_t)about.st_size - without; left > 0;) {
        const ssize_t count = read(file, bytes, left < sizeof bytes ? left : sizeof bytes);
        if (count <= 0) {
            return false;
        }
        gm_digest_add(digest, bytes, (size_t)count);
        left -= (size_t)count;
    }
    return without == 0 || read(file, last, sizeof *last) == (ssize_t)sizeof *last;
}

void gm_cache_drop(const char *folder, const struct gm_cache_key *key)
{
    char path[GM_CACHE_PATH];
    path_of(folder, key, path);
    remove(path); /* an empty folder, too, that would keep a library from its place */
}

int gm_cache_find(const char *folder, const struct gm_cache_key *key)
{
    char path[GM_CACHE_PATH];
    struct gm_digest digest;
    struct seal seal;
    path_of(folder, key, path);
    /* a pipe of that name must not block */
    const int file = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (file < 0) {
        return -1;
    }
    const bool read = digest_file(file, sizeof seal, &digest, &seal);
    gm_digest_add(&digest, key->text, sizeof key->text); /* a library that was moved here has another key */
    const bool whole =
        read && memcmp(seal.magic, magic, sizeof magic) == 0 && seal.a == digest.a && seal.b == digest.b;
    if (!whole) {
        gm_cache_drop(folder, key);
        close(file);
        return -1;
    }
    futimens(file, NULL); /* the oldest go first */
    return file;
}

static bool put_seal(int file, const struct gm_cache_key *key)
{
    struct gm_digest digest;
    if (file < 0 || !digest_file(file, 0, &digest, NULL)) {
        return false;
    }
    gm_digest_add(&digest, key->text, sizeof key->text);
    struct seal seal = {.a = digest.a, .b = digest.b};
    memcpy(seal.magic, magic, sizeof magic);
    return lseek(file, 0, SEEK_END) >= 0 && write(file, &seal, sizeof seal) == (ssize_t)sizeof seal;
}

bool gm_cache_keep(const char *folder, const char *library, const struct gm_cache_key *key, char *sentence)
{
    char path[GM_CACHE_PATH];
    path_of(folder, key, path);
    const int file = open(library, O_RDWR | O_CLOEXEC | O_NOFOLLOW);
    const bool sealed = put_seal(file, key);
    const bool whole = (file >= 0 && close(file) == 0 && sealed) ||
                       gm_refuse(sentence, "the compiler wrote nothing that can be kept");
    const bool keeps =
        whole && (rename(library, path) == 0 ||
                  gm_refuse(sentence, "%.400s could not be written: %s", path, strerror(errno)));
    size_t count = 0, kept = keeps, bytes = 0;
    struct gm_cache_entry *entries = NULL;
    gm_cache_list(folder, &entries, &count); /* an unreadable folder drops nothing */
    for (size_t i = 0; i < count; i++) {
        bytes += entries[i].size;
        if (strcmp(entries[i].key.text, key->text) == 0) {
            continue;
        }
        if (kept < MOST_ENTRIES && bytes <= MOST_BYTES) {
            kept++;
        } else {
            gm_cache_drop(folder, &entries[i].key);
        }
    }
    free(entries);
    return keeps;
}

static int is_entry(const struct dirent *file)
{
    const char *name = file->d_name;
    return strlen(name) == GM_KEY_TEXT - 1 + sizeof ending - 1 &&
           strspn(name, "0123456789abcdef") == GM_KEY_TEXT - 1 && strcmp(name + GM_KEY_TEXT - 1, ending) == 0;
}

static int is_other(const struct dirent *file)
{
    return !is_entry(file);
}

/* Lists the files of the folder that a filter chooses, malloc'ed. Returns their number, negative with errno if the
   folder, which may be missing, cannot be read. */
static int list_files(const char *folder, int (*filter)(const struct dirent *file), struct dirent ***files)
{
    *files = NULL;
    const int count = scandir(folder, files, filter, NULL);
    return count < 0 && errno == ENOENT ? 0 : count;
}

static bool find_file(const char *folder, const struct dirent *file, char path[GM_CACHE_PATH],
                      struct stat *about)
{
    snprintf(path, GM_CACHE_PATH, "%.3800s/%s", folder, file->d_name);
    return lstat(path, about) == 0;
}

static int later(const void *a, const void *b)
{
    const struct gm_cache_entry *one = a, *other = b;
    return one->used != other->used ? (one->used < other->used ? 1 : -1)
                                    : strcmp(one->key.text, other->key.text);
}

bool gm_cache_list(const char *folder, struct gm_cache_entry **entries, size_t *count)
{
    char path[GM_CACHE_PATH];
    struct dirent **files;
    struct stat about;
    const int found = list_files(folder, is_entry, &files);
    *entries = found > 0 ? calloc((size_t)found, sizeof **entries) : NULL;
    *count = 0;
    for (int i = 0; i < found; i++) {
        if (*entries && find_file(folder, files[i], path, &about) && S_ISREG(about.st_mode)) {
            struct gm_cache_entry *entry = &(*entries)[(*count)++];
            *entry = (struct gm_cache_entry){.size = (size_t)about.st_size, .used = about.st_mtime};
            memcpy(entry->key.text, files[i]->d_name, GM_KEY_TEXT - 1);
        }
        free(files[i]);
    }
    free(files);
    if (*count > 0) {
        qsort(*entries, *count, sizeof **entries, later);
    }
    return found >= 0;
}

/* Removes the files that a filter chooses, and counts them. A file that is not an entry stays unless it is regular and
   older than an hour; with `recent` its age does not matter. Returns false with a sentence if a removal fails. */
static bool remove_files(const char *folder, int (*filter)(const struct dirent *file), bool recent,
                         size_t *count, char *sentence)
{
    enum { HOUR = 3600 };
    char path[GM_CACHE_PATH];
    struct dirent **files;
    struct stat about = {0};
    bool all = true;
    const time_t now = time(NULL);
    const int found = list_files(folder, filter, &files);
    *count = 0;
    for (int i = 0; i < found; i++) {
        const bool there = find_file(folder, files[i], path, &about);
        free(files[i]);
        const bool kept = !S_ISREG(about.st_mode) || (!recent && about.st_mtime + HOUR >= now);
        if (!there || (filter == is_other && kept)) {
            continue;
        }
        /* a folder that is not empty belongs to the user; ENOENT: another process has removed the entry */
        if (remove(path) == 0) {
            ++*count;
        } else if (all && errno != ENOENT) {
            all = gm_refuse(sentence, "%.400s could not be removed: %s", path, strerror(errno));
        }
    }
    free(files);
    return all;
}

void gm_cache_sweep(const char *folder)
{
    char sentence[GM_MESSAGE];
    size_t count;
    remove_files(folder, is_other, false, &count, sentence);
}

bool gm_cache_clear(const char *folder, size_t *count, char *sentence)
{
    const bool others = remove_files(folder, is_other, true, count, sentence);
    return remove_files(folder, is_entry, true, count, sentence) && others;
}
