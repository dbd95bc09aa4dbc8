#include "model/tally.h"

#include <inttypes.h>
#include <stdio.h>

void md_tally_add(md_tally *sum, const md_tally *part)
{
    sum->edits += part->edits;
    sum->meshes += part->meshes;
    sum->undone += part->undone;
    sum->rolled_back += part->rolled_back;
    sum->faces = part->faces > sum->faces ? part->faces : sum->faces;
    for (size_t i = 0; i < MD_ROWS; i++) {
        md_row_tally *row = &sum->row[i];
        const md_row_tally *from = &part->row[i];
        row->done += from->done;
        row->starved = from->starved > row->starved ? from->starved : row->starved;
        for (int s = 0; s < HE_STATUS_COUNT; s++) {
            row->refused[s] += from->refused[s];
        }
    }
}

void md_tally_print(const md_tally *t, const char *name)
{
    uint64_t done = 0;
    for (size_t i = 0; i < MD_ROWS; i++) {
        done += t->row[i].done;
    }
    printf("%s: %" PRIu64 " edits, %" PRIu64 " of them refused, on %" PRIu64
           " meshes of up to %u faces; %" PRIu64 " steps undone and redone, %" PRIu64
           " edits rolled back\n",
           name, t->edits, t->edits - done, t->meshes, t->faces, t->undone, t->rolled_back);
}

static bool is_missing(const he_op *op, const md_row_tally *row, size_t i)
{
    return row->refused[op->refusals[i]] == 0;
}

void md_tally_print_rows(const md_tally *t, const char *before)
{
    for (size_t k = 0; k < he_op_count(); k++) {
        const he_op *op = he_op_at(k);
        const md_row_tally *row = &t->row[k];
        printf("%s%-21s %7" PRIu64 " done, N-th allocation up to %u; refused:", before, op->name,
               row->done, row->starved);
        const char *none = " never";
        for (int s = 0; s < HE_STATUS_COUNT; s++) {
            if (row->refused[s] > 0) {
                printf(" %s %" PRIu64, he_status_slug((he_status)s), row->refused[s]);
                none = "";
            }
        }
        printf("%s", none);
        const char *never = "; never:";
        for (size_t i = 0; i < HE_OP_REFUSALS && op->refusals[i] != HE_OK; i++) {
            if (is_missing(op, row, i)) {
                printf("%s %s", never, he_status_slug(op->refusals[i]));
                never = "";
            }
        }
        printf("\n");
    }
}

size_t md_tally_idle(const md_tally *t)
{
    size_t n = 0;
    for (size_t k = 0; k < he_op_count(); k++) {
        n += t->row[k].done == 0;
    }
    return n;
}

size_t md_tally_missing(const md_tally *t)
{
    size_t n = 0;
    for (size_t k = 0; k < he_op_count(); k++) {
        const he_op *op = he_op_at(k);
        for (size_t i = 0; i < HE_OP_REFUSALS && op->refusals[i] != HE_OK; i++) {
            n += is_missing(op, &t->row[k], i);
        }
    }
    return n;
}
