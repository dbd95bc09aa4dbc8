/* job_measure.c - measures the table of jobs for the metrics. */
#include "api/job/job_entry.h"

static uint64_t micros_between(double from, double to)
{
    /* The time is taken as 0 if the system clock was set back. */
    return to > from ? (uint64_t)((to - from) * 1e6) : 0;
}

void api_job_count_begin(api_job_entry *job)
{
    st_histogram_add(&job->table->waited, st_scale_micros,
                     micros_between(job->facts.created, job->facts.started));
}

void api_job_count_end(api_job_entry *job)
{
    job->table->ended[job->facts.state]++;
    if (job->facts.started > 0) {
        st_histogram_add(&job->table->ran, st_scale_micros,
                         micros_between(job->facts.started, job->facts.finished));
    }
}

void api_job_measure(api_job_table *table, api_job_measures *out)
{
    *out = (api_job_measures){.most_listeners = API_JOB_LISTENERS};
    pthread_mutex_lock(&table->lock);
    for (const api_job_entry *job = table->first; job != NULL; job = job->next) {
        out->in_state[job->facts.state]++;
    }
    for (size_t i = 0; i < API_JOB_STATES; i++) {
        out->ended[i] = table->ended[i];
    }
    out->bytes = table->bytes;
    out->listeners = table->listeners;
    pthread_mutex_unlock(&table->lock);
    st_histogram_copy(&table->waited, &out->waited);
    st_histogram_copy(&table->ran, &out->ran);
}
