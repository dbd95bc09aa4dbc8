// A body or an answer can have several media types; orval is to generate code for JSON.
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
