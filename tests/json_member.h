/* json_member.h - the members of a JSON object that must be there. */
#ifndef TESTS_JSON_MEMBER_H
#define TESTS_JSON_MEMBER_H

#include <cjson/cJSON.h>

/* Returns the member with this name; fails the test if there is none. */
const cJSON *json_member(const cJSON *object, const char *name);

#endif
