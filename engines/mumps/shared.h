/* What the files of this program share. */
#ifndef SHARED_H
#define SHARED_H
#define _GNU_SOURCE
#include <dmumps_c.h>
#include <inttypes.h>
#include <mpi.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ICNTL(i) icntl[(i) - 1]
#define CNTL(i) cntl[(i) - 1]
#define INFO(i) info[(i) - 1]
#define INFOG(i) infog[(i) - 1]
#define RINFOG(i) rinfog[(i) - 1]
/* No length of a file that is expected. */
#define ANY SIZE_MAX

/* ranks.c: what all others stand on. */
extern int rank, ranks;
extern const char *folder;

/* Ends all ranks. */
void die(const char *format, ...);
/* Zeros; ends all ranks if there is no memory. */
void *get(size_t count, size_t size);
/* A line on the standard output, from rank 0 alone. */
void answer(const char *format, ...);

/* words.c: files of words. The folder is put in front of names; `part`, if not negative, is appended to them. */
typedef struct {
    FILE *file;
    char path[4096];
    size_t count;
    uint64_t sum;
} Words;
Words read_from(const char *name, int part, size_t expected);
void read_words(Words *from, void *to, size_t count);
/* Checks the sum and deletes the file. */
void end_reading(Words *from);
Words write_to(const char *name, const char *ending, int part, size_t count);
void write_words(Words *to, const void *words, size_t count);
void end_writing(Words *to);

/* cells, in Rust: hands out the entries of the matrices of some cells. Returns 0, 1 + the row where one is no number, or -1 if the words are those of another version. */
int64_t stickslip_cells(const uint64_t *words, size_t count, void (*take)(void *to, uint32_t row, uint32_t column, double value), void *to);

/* matrix.c: the share of this rank of a matrix, as MUMPS takes it. Entries that it was sent come first. */
void read_matrix(DMUMPS_STRUC_C *body, const char *file);
/* Adds those of its cells. Returns 0, or 1 + the row where one is no number, on all ranks. */
int64_t make_cells(DMUMPS_STRUC_C *body, const char *file);
void free_matrix(DMUMPS_STRUC_C *body);

/* schur.c: a dense symmetric matrix over a grid of all ranks, of which the lower triangle counts. */
typedef struct Grid Grid;
/* Lets MUMPS leave the Schur complement there, before the analysis. */
Grid *plan_grid(DMUMPS_STRUC_C *body);
/* Takes memory for it, before the factorisation. */
void make_room(Grid *grid, DMUMPS_STRUC_C *body);
void drop_grid(Grid *grid);
/* The sum of the diagonal, on rank 0. */
double trace(const Grid *grid);
/* Products with vectors, FILE -> FILE.out. */
void multiply(const Grid *grid, int columns, const char *file);
/* Adds SIGMA times the products of the vectors in FILE with themselves, and inverts. Returns 0, or the row, from 1 on, that is not positive. */
int invert(Grid *grid, int columns, double sigma, const char *file);
#endif
