/* Files of words: eight bytes that name the format, the count of words, the words (eight bytes each, of this machine), and their checksum. */
#include "shared.h"
#include <unistd.h>

#define MAGIC 0x31706d75736c7073ULL /* "spslump1" */

static void mix(uint64_t *sum, const void *words, size_t count) {
    const unsigned char *bytes = words;
    for (size_t i = 0; i < count; i++) {
        uint64_t word;
        memcpy(&word, bytes + 8 * i, 8);
        *sum = (*sum ^ word) * 0x9e3779b97f4a7c15ULL;
        *sum ^= *sum >> 32;
    }
}

static void name_file(Words *words, const char *name, const char *ending, int part) {
    char number[16] = "";
    if (part >= 0) snprintf(number, sizeof number, ".%d", part);
    snprintf(words->path, sizeof words->path, "%s/%s%s%s", folder, name, ending, number);
}

Words read_from(const char *name, int part, size_t expected) {
    uint64_t head[2];
    Words words = {0};
    name_file(&words, name, "", part);
    words.file = fopen(words.path, "rb");
    if (!words.file) die("%s cannot be read; set STICKSLIP_MUMPS_DIR to a folder that all machines see", words.path);
    if (fread(head, 8, 2, words.file) != 2 || head[0] != MAGIC) die("%s is something else", words.path);
    if (head[1] != expected && expected != ANY) die("%s has %" PRIu64 " words instead of %zu", words.path, head[1], expected);
    words.count = head[1];
    return words;
}

void read_words(Words *from, void *to, size_t count) {
    if (fread(to, 8, count, from->file) != count) die("%s is cut short", from->path);
    mix(&from->sum, to, count);
}

void end_reading(Words *from) {
    uint64_t end;
    if (fread(&end, 8, 1, from->file) != 1 || end != from->sum) die("%s is damaged", from->path);
    fclose(from->file);
    unlink(from->path);
}

Words write_to(const char *name, const char *ending, int part, size_t count) {
    uint64_t head[2] = {MAGIC, count};
    Words words = {.count = count};
    name_file(&words, name, ending, part);
    words.file = fopen(words.path, "wb");
    if (!words.file || fwrite(head, 8, 2, words.file) != 2) die("%s cannot be written", words.path);
    return words;
}

void write_words(Words *to, const void *words, size_t count) {
    mix(&to->sum, words, count);
    if (fwrite(words, 8, count, to->file) != count) die("%s cannot be written", to->path);
}

void end_writing(Words *to) {
    if (fwrite(&to->sum, 8, 1, to->file) != 1 || fclose(to->file)) die("%s cannot be written", to->path);
}
