/* What the gate and the metrics cost a request, in microseconds of one thread:
 *
 *     token 0.31        one of a thousand tokens is found
 *     metrics 0.04      a GET is counted
 *
 * Each figure is the least of several runs, because other programs can only make a run longer. */
#include "api/describe/routes.h"
#include "api/metric/metrics.h"
#include "api/token/token_set.h"
#include "system/clock.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { TOKENS = 1000, RUNS = 7, ROUNDS = 200000, TEXT = 32 };

static void text_of(int number, char text[TEXT])
{
    snprintf(text, TEXT, "hedge_token_number_%08d", number);
}

static api_tokens *load_tokens(void)
{
    static char file[TOKENS * API_TOKEN_SHORT_LINE];
    char message[API_TOKENS_MESSAGE];
    size_t used = 0;
    for (int i = 0; i < TOKENS; i++) {
        char name[16], text[TEXT], line[API_TOKEN_SHORT_LINE];
        snprintf(name, sizeof name, "t%d", i);
        text_of(i, text);
        api_token_file_line(name, API_ROLE_READ, text, line);
        used += (size_t)snprintf(file + used, sizeof file - used, "%s\n", line);
    }
    api_tokens *tokens = api_tokens_new();
    if (tokens == NULL || !api_tokens_load(tokens, file, used, message)) {
        fprintf(stderr, "checks: the tokens were not loaded\n");
        exit(1);
    }
    return tokens;
}

static void find_tokens(void *context)
{
    static char texts[TOKENS][TEXT];
    if (texts[0][0] == '\0') {
        for (int i = 0; i < TOKENS; i++) {
            text_of(i, texts[i]);
        }
    }
    for (int i = 0; i < ROUNDS; i++) {
        const char *text = texts[i * 7 % TOKENS];
        api_token *token = api_tokens_find(context, text, strlen(text), 0);
        if (token == NULL) {
            fprintf(stderr, "checks: a token was not found\n");
            exit(1);
        }
        api_token_release(token);
    }
}

static void count_requests(void *context)
{
    const api_served served = {.route = 3, .method = "GET", .status = 200, .bytes_out = 99};
    for (int i = 0; i < ROUNDS; i++) {
        api_served one = served;
        one.micros = (uint64_t)i % 1000;
        api_count(context, API_COUNT_BEGUN);
        api_count_request(context, &one);
    }
}

/* Returns the microseconds of one round. */
static double measure(void (*run)(void *context), void *context)
{
    double least = 1e9;
    run(context); /* this round is not measured, because the caches are cold */
    for (int i = 0; i < RUNS; i++) {
        const uint64_t begun = st_clock_micros();
        run(context);
        const double took = (double)(st_clock_micros() - begun) / ROUNDS;
        least = took < least ? took : least;
    }
    return least;
}

int main(void)
{
    api_tokens *tokens = load_tokens();
    api_metrics *metrics = api_metrics_new(api_routes().count);
    if (metrics == NULL) {
        return 1;
    }
    printf("token %.4f\n", measure(find_tokens, tokens));
    printf("metrics %.4f\n", measure(count_requests, metrics));
    api_metrics_free(metrics);
    api_tokens_free(tokens);
    return 0;
}
