/* Imports a corpus of real and hostile files if it lies beside the project, else the test is
 * skipped. The daemon must do with each file what the manifest of the corpus expects, must read the
 * files that it exports, and must free all memory after a refused file. */
#include "tests/e2e/client.h"
#include "tests/e2e/transport.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#define CHECKER "../shared/corpus/check_corpus.py"

static void each_file_of_the_corpus_is_read_or_refused_as_expected(void **state)
{
    (void)state;
    if (access(CHECKER, R_OK) != 0) {
        skip();
    }
    transport_skip_over(TRANSPORT_UNIX, "the corpus' checker opens URLs alone");
    daemon_process *d = daemon_start(NULL);
    if (transport_get() == TRANSPORT_TLS) {
        assert_int_equal(setenv("SSL_CERT_FILE", transport_certificate(), 1), 0);
    }
    char command[256], line[512], last[512] = "";
    snprintf(command, sizeof command, "python3 " CHECKER " --base %s --roundtrip --pid %d 2>&1",
             daemon_url(d), (int)daemon_pid(d));
    FILE *output = popen(command, "r");
    assert_non_null(output);
    while (fgets(line, sizeof line, output) != NULL) {
        print_message("%s", line);
        memcpy(last, line, sizeof last);
    }
    int status = pclose(output);
    assert_int_equal(daemon_stop(d), 0);
    assert_int_equal(WEXITSTATUS(status), 0);
    assert_non_null(strstr(last, " passed, 0 failed"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_file_of_the_corpus_is_read_or_refused_as_expected)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
