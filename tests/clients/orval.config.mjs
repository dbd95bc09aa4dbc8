// Where a body or an answer may be of several media types, orval is told that JSON is meant.
export default {
    hedge: {
        input: './work/openapi.json',
        output: {
            target: './work/orval/made/api.ts',
            client: 'fetch',
            override: { contentType: { include: ['application/json'] } },
        },
    },
};
