/* The share of a matrix that a rank gives to MUMPS: entries that it was sent, and those of the cells whose matrices it makes. */
#include "shared.h"

#define CHUNK 65536

/* The same memory with another length. */
static void *resize(void *memory, size_t count, size_t size) {
    void *moved = realloc(memory, count ? count * size : 1);
    if (!moved) die("no memory for %zu numbers", count);
    return moved;
}

/* Room for so many entries of the share of this rank. */
static void make_room_for(DMUMPS_STRUC_C *body, size_t count) {
    body->irn_loc = resize(body->irn_loc, count, sizeof *body->irn_loc);
    body->jcn_loc = resize(body->jcn_loc, count, sizeof *body->jcn_loc);
    body->a_loc = resize(body->a_loc, count, sizeof *body->a_loc);
}

/* A share that grows. */
typedef struct {
    DMUMPS_STRUC_C *body;
    size_t room;
} Growing;

static void take(void *to, uint32_t row, uint32_t column, double value) {
    Growing *share = to;
    DMUMPS_STRUC_C *body = share->body;
    size_t at = body->nnz_loc;
    if (at == share->room) make_room_for(body, share->room += CHUNK + share->room / 4);
    body->irn_loc[at] = (MUMPS_INT)row + 1;
    body->jcn_loc[at] = (MUMPS_INT)column + 1;
    body->a_loc[at] = value;
    body->nnz_loc++;
}

/* Words (row, column) of 32 bits each, and values, in turn. */
void read_matrix(DMUMPS_STRUC_C *body, const char *file) {
    uint64_t *pairs = get(2 * CHUNK, 8);
    Words from = read_from(file, rank, ANY);
    Growing share = {body, from.count / 2};
    make_room_for(body, share.room);
    for (size_t left = share.room; left > 0;) {
        size_t some = left < CHUNK ? left : CHUNK;
        read_words(&from, pairs, 2 * some);
        for (size_t i = 0; i < some; i++, left--) {
            double value;
            memcpy(&value, pairs + 2 * i + 1, 8);
            take(&share, (uint32_t)pairs[2 * i], (uint32_t)(pairs[2 * i] >> 32), value);
        }
    }
    end_reading(&from);
    free(pairs);
}

/* Makes the matrices of the cells of this rank. Returns 0, or 1 + the row where one is no number, on all ranks. */
int64_t make_cells(DMUMPS_STRUC_C *body, const char *file) {
    char name[128];
    Growing share = {body, body->nnz_loc};
    snprintf(name, sizeof name, "%s.cells", file);
    Words from = read_from(name, rank, ANY);
    uint64_t *words = get(from.count, 8);
    read_words(&from, words, from.count);
    end_reading(&from);
    int64_t most = 0, wrong = stickslip_cells(words, from.count, take, &share);
    free(words);
    if (wrong < 0) die("it was built from another version than stickslip: `cargo xtask engine mumps`");
    make_room_for(body, body->nnz_loc);
    MPI_Allreduce(&wrong, &most, 1, MPI_INT64_T, MPI_MAX, MPI_COMM_WORLD);
    return most;
}

void free_matrix(DMUMPS_STRUC_C *body) {
    free(body->irn_loc);
    free(body->jcn_loc);
    free(body->a_loc);
    body->irn_loc = body->jcn_loc = NULL;
    body->a_loc = NULL;
    body->nnz_loc = 0;
}
