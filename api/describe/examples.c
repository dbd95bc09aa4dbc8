#include "api/describe/examples.h"

#include <string.h>

static const api_example examples[] = {
    {.route = "replace_mesh",
     .target = "/v1/meshes/kite",
     .consumes = "application/json",
     .request = "{\"name\":\"kite\",\"vertices\":[[0,0,0],[1,0,0],[1,1,0],[0,1,0]],\"faces\":[[0,"
                "1,2],[0,2,3]]}",
     .status = 201,
     .produces = "application/json",
     .response = "{\"id\":\"kite\",\"name\":\"kite\",\"revision\":1,\"counts\":{\"vertices\":4,"
                 "\"halfedges\":10,\"edges\":5,\"faces\":2,\"boundary_loops\":1,"
                 "\"isolated_vertices\":0,\"components\":1,\"components_by_edge\":1},\"euler\":1,"
                 "\"genus\":0,\"closed\":false,\"manifold\":true,\"degrees\":{\"3\":2},"
                 "\"bbox\":{\"min\":[0,0,0],\"max\":[1,1,0]},\"area\":1,\"volume\":null,"
                 "\"memory_bytes\":408,\"created\":\"2026-01-01T12:00:00.000Z\","
                 "\"modified\":\"2026-01-01T12:00:00.000Z\",\"import\":{\"format\":\"json\","
                 "\"vertices\":4,\"faces\":2,\"repairs\":[],\"warnings\":[]}}"},
    {.route = "create_mesh",
     .target = "/v1/meshes?id=box",
     .consumes = "application/json",
     .request = "{\"shape\":\"cube\",\"size\":2}",
     .status = 201,
     .produces = "application/json",
     .response = "{\"id\":\"box\",\"name\":\"\",\"revision\":1,\"counts\":{\"vertices\":8,"
                 "\"halfedges\":24,\"edges\":12,\"faces\":6,\"boundary_loops\":0,"
                 "\"isolated_vertices\":0,\"components\":1,\"components_by_edge\":1},\"euler\":2,"
                 "\"genus\":0,\"closed\":true,\"manifold\":true,\"degrees\":{\"4\":6},"
                 "\"bbox\":{\"min\":[-1,-1,-1],\"max\":[1,1,1]},\"area\":24,\"volume\":8,"
                 "\"memory_bytes\":760,\"created\":\"2026-01-01T12:00:00.000Z\","
                 "\"modified\":\"2026-01-01T12:00:00.000Z\",\"import\":{\"format\":\"shape\","
                 "\"vertices\":8,\"faces\":6,\"repairs\":[],\"warnings\":[]}}"},
    {.route = "create_mesh",
     .target = "/v1/meshes?id=tile&name=tile",
     .consumes = "model/obj",
     .request = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
     .status = 201,
     .produces = "application/json",
     .response = "{\"id\":\"tile\",\"name\":\"tile\",\"revision\":1,\"counts\":{\"vertices\":3,"
                 "\"halfedges\":6,\"edges\":3,\"faces\":1,\"boundary_loops\":1,"
                 "\"isolated_vertices\":0,\"components\":1,\"components_by_edge\":1},\"euler\":1,"
                 "\"genus\":0,\"closed\":false,\"manifold\":true,\"degrees\":{\"3\":1},"
                 "\"bbox\":{\"min\":[0,0,0],\"max\":[1,1,0]},\"area\":0.5,\"volume\":null,"
                 "\"memory_bytes\":312,\"created\":\"2026-01-01T12:00:00.000Z\","
                 "\"modified\":\"2026-01-01T12:00:00.000Z\",\"import\":{\"format\":\"obj\","
                 "\"vertices\":3,\"faces\":1,\"repairs\":[],\"warnings\":[]}}"},
    {.route = "create_mesh",
     .target = "/v1/meshes?id=tile-off&repair=drop_duplicates",
     .consumes = "model/x-off",
     .request = "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 1 2 0\n",
     .status = 201,
     .produces = "application/json",
     .response = "{\"id\":\"tile-off\",\"name\":\"\",\"revision\":1,\"counts\":{\"vertices\":3,"
                 "\"halfedges\":6,\"edges\":3,\"faces\":1,\"boundary_loops\":1,"
                 "\"isolated_vertices\":0,\"components\":1,\"components_by_edge\":1},\"euler\":1,"
                 "\"genus\":0,\"closed\":false,\"manifold\":true,\"degrees\":{\"3\":1},"
                 "\"bbox\":{\"min\":[0,0,0],\"max\":[1,1,0]},\"area\":0.5,\"volume\":null,"
                 "\"memory_bytes\":312,\"created\":\"2026-01-01T12:00:00.000Z\","
                 "\"modified\":\"2026-01-01T12:00:00.000Z\",\"import\":{\"format\":\"off\","
                 "\"vertices\":3,\"faces\":2,\"repairs\":[{\"repair\":\"drop_duplicates\","
                 "\"count\":1,\"gone\":[1],\"into\":[0],\"lines\":[7]}],\"warnings\":[]}}"},
    {.route = "create_mesh",
     .target = "/v1/meshes?id=tile-gltf",
     .consumes = "model/gltf+json",
     .request = "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,"
                "\"uri\":\"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],"
                "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{"
                "\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
                "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}",
     .status = 201,
     .produces = "application/json",
     .response = "{\"id\":\"tile-gltf\",\"name\":\"\",\"revision\":1,\"counts\":{\"vertices\":3,"
                 "\"halfedges\":6,\"edges\":3,\"faces\":1,\"boundary_loops\":1,"
                 "\"isolated_vertices\":0,\"components\":1,\"components_by_edge\":1},\"euler\":1,"
                 "\"genus\":0,\"closed\":false,\"manifold\":true,\"degrees\":{\"3\":1},"
                 "\"bbox\":{\"min\":[0,0,0],\"max\":[1,1,0]},\"area\":0.5,\"volume\":null,"
                 "\"memory_bytes\":312,\"created\":\"2026-01-01T12:00:00.000Z\","
                 "\"modified\":\"2026-01-01T12:00:00.000Z\",\"import\":{\"format\":\"gltf\","
                 "\"vertices\":3,\"faces\":1,\"repairs\":[],\"warnings\":[]}}"},
    {.route = "list_meshes",
     .target = "/v1/meshes",
     .status = 200,
     .produces = "application/json",
     .response = "{\"items\":[{\"id\":\"box\",\"name\":\"\",\"revision\":1,"
                 "\"counts\":{\"vertices\":8,\"halfedges\":24,\"edges\":12,\"faces\":6}},"
                 "{\"id\":\"kite\",\"name\":\"kite\",\"revision\":1,\"counts\":{\"vertices\":4,"
                 "\"halfedges\":10,\"edges\":5,\"faces\":2}},{\"id\":\"tile\",\"name\":\"tile\","
                 "\"revision\":1,\"counts\":{\"vertices\":3,\"halfedges\":6,\"edges\":3,"
                 "\"faces\":1}},{\"id\":\"tile-gltf\",\"name\":\"\",\"revision\":1,"
                 "\"counts\":{\"vertices\":3,\"halfedges\":6,\"edges\":3,\"faces\":1}},"
                 "{\"id\":\"tile-off\",\"name\":\"\",\"revision\":1,"
                 "\"counts\":{\"vertices\":3,\"halfedges\":6,\"edges\":3,\"faces\":1}}],"
                 "\"next\":null,\"listeners\":0}"},
    {.route = "get_mesh",
     .target = "/v1/meshes/kite",
     .status = 200,
     .produces = "application/json",
     .response = "{\"id\":\"kite\",\"name\":\"kite\",\"revision\":1,\"counts\":{\"vertices\":4,"
                 "\"halfedges\":10,\"edges\":5,\"faces\":2,\"boundary_loops\":1,"
                 "\"isolated_vertices\":0,\"components\":1,\"components_by_edge\":1},\"euler\":1,"
                 "\"genus\":0,\"closed\":false,\"manifold\":true,\"degrees\":{\"3\":2},"
                 "\"bbox\":{\"min\":[0,0,0],\"max\":[1,1,0]},\"area\":1,\"volume\":null,"
                 "\"memory_bytes\":408,\"created\":\"2026-01-01T12:00:00.000Z\","
                 "\"modified\":\"2026-01-01T12:00:00.000Z\"}"},
    {.route = "update_mesh",
     .target = "/v1/meshes/kite",
     .consumes = "application/merge-patch+json",
     .request = "{\"name\":\"Kite\"}",
     .status = 200,
     .produces = "application/json",
     .response = "{\"id\":\"kite\",\"name\":\"Kite\",\"revision\":1,\"counts\":{\"vertices\":4,"
                 "\"halfedges\":10,\"edges\":5,\"faces\":2,\"boundary_loops\":1,"
                 "\"isolated_vertices\":0,\"components\":1,\"components_by_edge\":1},\"euler\":1,"
                 "\"genus\":0,\"closed\":false,\"manifold\":true,\"degrees\":{\"3\":2},"
                 "\"bbox\":{\"min\":[0,0,0],\"max\":[1,1,0]},\"area\":1,\"volume\":null,"
                 "\"memory_bytes\":408,\"created\":\"2026-01-01T12:00:00.000Z\","
                 "\"modified\":\"2026-01-01T12:00:00.000Z\"}"},
    {.route = "export_mesh",
     .target = "/v1/meshes/kite/content",
     .status = 200,
     .produces = "application/json",
     .response = "{\"name\":\"Kite\",\"vertices\":[\n[0,0,0],\n[1,0,0],\n[1,1,0],\n[0,1,0]],"
                 "\n\"faces\":[\n[0,1,2],\n[0,2,3]]}\n"},
    {.route = "export_mesh",
     .target = "/v1/meshes/kite/content",
     .status = 200,
     .produces = "model/obj",
     .response = "# 4 vertices, 2 faces\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n"},
    {.route = "export_mesh",
     .target = "/v1/meshes/kite/content",
     .status = 200,
     .produces = "model/x-off",
     .response = "OFF\n4 2 5\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3\n"},
    {.route = "copy_mesh",
     .target = "/v1/meshes/kite/copy",
     .consumes = "application/json",
     .request = "{\"id\":\"kite-2\",\"name\":\"Another kite\"}",
     .status = 201,
     .produces = "application/json",
     .response = "{\"id\":\"kite-2\",\"name\":\"Another kite\",\"revision\":1,"
                 "\"counts\":{\"vertices\":4,\"halfedges\":10,\"edges\":5,\"faces\":2,"
                 "\"boundary_loops\":1,\"isolated_vertices\":0,\"components\":1,"
                 "\"components_by_edge\":1},\"euler\":1,\"genus\":0,\"closed\":false,"
                 "\"manifold\":true,\"degrees\":{\"3\":2},\"bbox\":{\"min\":[0,0,0],\"max\":[1,1,"
                 "0]},\"area\":1,\"volume\":null,\"memory_bytes\":408,"
                 "\"created\":\"2026-01-01T12:00:00.000Z\",\"modified\":\"2026-01-01T12:00:00.000"
                 "Z\"}"},
    {.route = "list_vertices",
     .target = "/v1/meshes/kite/vertices",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"items\":[{\"id\":0,\"position\":[0,0,0],\"halfedge\":9,"
                 "\"degree\":3,\"boundary\":true,\"isolated\":false},{\"id\":1,\"position\":[1,0,"
                 "0],\"halfedge\":1,\"degree\":2,\"boundary\":true,\"isolated\":false},{\"id\":2,"
                 "\"position\":[1,1,0],\"halfedge\":3,\"degree\":3,\"boundary\":true,"
                 "\"isolated\":false},{\"id\":3,\"position\":[0,1,0],\"halfedge\":7,\"degree\":2,"
                 "\"boundary\":true,\"isolated\":false}],\"next\":null}"},
    {.route = "list_edges",
     .target = "/v1/meshes/kite/edges",
     .status = 200,
     .produces = "application/x-ndjson",
     .response = "{\"id\":0,\"halfedges\":[0,1],\"vertices\":[0,1],\"faces\":[0,null],"
                 "\"length\":1,\"boundary\":true}\n{\"id\":1,\"halfedges\":[2,3],\"vertices\":[1,"
                 "2],\"faces\":[0,null],\"length\":1,\"boundary\":true}\n{\"id\":2,"
                 "\"halfedges\":[4,5],\"vertices\":[2,0],\"faces\":[0,1],"
                 "\"length\":1.4142135623730951,\"boundary\":false}\n{\"id\":3,\"halfedges\":[6,"
                 "7],\"vertices\":[2,3],\"faces\":[1,null],\"length\":1,"
                 "\"boundary\":true}\n{\"id\":4,\"halfedges\":[8,9],\"vertices\":[3,0],"
                 "\"faces\":[1,null],\"length\":1,\"boundary\":true}\n{\"end\":true,"
                 "\"count\":5}\n"},
    {.route = "list_halfedges",
     .target = "/v1/meshes/kite/halfedges",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"items\":[{\"id\":0,\"twin\":1,\"next\":2,\"prev\":4,"
                 "\"origin\":0,\"target\":1,\"edge\":0,\"face\":0,\"boundary\":false},{\"id\":1,"
                 "\"twin\":0,\"next\":9,\"prev\":3,\"origin\":1,\"target\":0,\"edge\":0,"
                 "\"face\":null,\"boundary\":true},{\"id\":2,\"twin\":3,\"next\":4,\"prev\":0,"
                 "\"origin\":1,\"target\":2,\"edge\":1,\"face\":0,\"boundary\":false},{\"id\":3,"
                 "\"twin\":2,\"next\":1,\"prev\":7,\"origin\":2,\"target\":1,\"edge\":1,"
                 "\"face\":null,\"boundary\":true},{\"id\":4,\"twin\":5,\"next\":0,\"prev\":2,"
                 "\"origin\":2,\"target\":0,\"edge\":2,\"face\":0,\"boundary\":false},{\"id\":5,"
                 "\"twin\":4,\"next\":6,\"prev\":8,\"origin\":0,\"target\":2,\"edge\":2,"
                 "\"face\":1,\"boundary\":false},{\"id\":6,\"twin\":7,\"next\":8,\"prev\":5,"
                 "\"origin\":2,\"target\":3,\"edge\":3,\"face\":1,\"boundary\":false},{\"id\":7,"
                 "\"twin\":6,\"next\":3,\"prev\":9,\"origin\":3,\"target\":2,\"edge\":3,"
                 "\"face\":null,\"boundary\":true},{\"id\":8,\"twin\":9,\"next\":5,\"prev\":6,"
                 "\"origin\":3,\"target\":0,\"edge\":4,\"face\":1,\"boundary\":false},{\"id\":9,"
                 "\"twin\":8,\"next\":7,\"prev\":1,\"origin\":0,\"target\":3,\"edge\":4,"
                 "\"face\":null,\"boundary\":true}],\"next\":null}"},
    {.route = "list_edges",
     .target = "/v1/meshes/kite/edges",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"items\":[{\"id\":0,\"halfedges\":[0,1],\"vertices\":[0,1],"
                 "\"faces\":[0,null],\"length\":1,\"boundary\":true},{\"id\":1,\"halfedges\":[2,"
                 "3],\"vertices\":[1,2],\"faces\":[0,null],\"length\":1,\"boundary\":true},"
                 "{\"id\":2,\"halfedges\":[4,5],\"vertices\":[2,0],\"faces\":[0,1],"
                 "\"length\":1.4142135623730951,\"boundary\":false},{\"id\":3,\"halfedges\":[6,7],"
                 "\"vertices\":[2,3],\"faces\":[1,null],\"length\":1,\"boundary\":true},{\"id\":4,"
                 "\"halfedges\":[8,9],\"vertices\":[3,0],\"faces\":[1,null],\"length\":1,"
                 "\"boundary\":true}],\"next\":null}"},
    {.route = "list_faces",
     .target = "/v1/meshes/kite/faces",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"items\":[{\"id\":0,\"halfedge\":0,\"degree\":3,"
                 "\"vertices\":[0,1,2],\"halfedges\":[0,2,4],\"area\":0.5,\"normal\":[0,0,1],"
                 "\"centroid\":[0.6666666666666666,0.3333333333333333,0]},{\"id\":1,"
                 "\"halfedge\":5,\"degree\":3,\"vertices\":[0,2,3],\"halfedges\":[5,6,8],"
                 "\"area\":0.5,\"normal\":[0,0,1],\"centroid\":[0.3333333333333333,"
                 "0.6666666666666666,0]}],\"next\":null}"},
    {.route = "get_vertex",
     .target = "/v1/meshes/kite/vertices/2",
     .status = 200,
     .produces = "application/json",
     .response = "{\"id\":2,\"position\":[1,1,0],\"halfedge\":3,\"degree\":3,\"boundary\":true,"
                 "\"isolated\":false}"},
    {.route = "get_halfedge",
     .target = "/v1/meshes/kite/halfedges/0",
     .status = 200,
     .produces = "application/json",
     .response = "{\"id\":0,\"twin\":1,\"next\":2,\"prev\":4,\"origin\":0,\"target\":1,"
                 "\"edge\":0,\"face\":0,\"boundary\":false}"},
    {.route = "get_edge",
     .target = "/v1/meshes/kite/edges/2",
     .status = 200,
     .produces = "application/json",
     .response = "{\"id\":2,\"halfedges\":[4,5],\"vertices\":[2,0],\"faces\":[0,1],"
                 "\"length\":1.4142135623730951,\"boundary\":false}"},
    {.route = "get_face",
     .target = "/v1/meshes/kite/faces/1",
     .status = 200,
     .produces = "application/json",
     .response = "{\"id\":1,\"halfedge\":5,\"degree\":3,\"vertices\":[0,2,3],\"halfedges\":[5,6,"
                 "8],\"area\":0.5,\"normal\":[0,0,1],\"centroid\":[0.3333333333333333,"
                 "0.6666666666666666,0]}"},
    {.route = "list_vertex_vertices",
     .target = "/v1/meshes/kite/vertices/2/vertices",
     .status = 200,
     .produces = "application/json",
     .response =
         "{\"revision\":1,\"of\":{\"vertex\":2},\"relation\":\"vertices\",\"ids\":[1,3,0]}"},
    {.route = "list_vertex_outgoing",
     .target = "/v1/meshes/kite/vertices/2/outgoing",
     .status = 200,
     .produces = "application/json",
     .response =
         "{\"revision\":1,\"of\":{\"vertex\":2},\"relation\":\"outgoing\",\"ids\":[3,6,4]}"},
    {.route = "list_vertex_incoming",
     .target = "/v1/meshes/kite/vertices/2/incoming",
     .status = 200,
     .produces = "application/json",
     .response =
         "{\"revision\":1,\"of\":{\"vertex\":2},\"relation\":\"incoming\",\"ids\":[2,7,5]}"},
    {.route = "list_vertex_edges",
     .target = "/v1/meshes/kite/vertices/2/edges",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"of\":{\"vertex\":2},\"relation\":\"edges\",\"ids\":[1,3,2]}"},
    {.route = "list_vertex_faces",
     .target = "/v1/meshes/kite/vertices/2/faces",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"of\":{\"vertex\":2},\"relation\":\"faces\",\"ids\":[1,0]}"},
    {.route = "list_halfedge_loop",
     .target = "/v1/meshes/kite/halfedges/4/loop",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"of\":{\"halfedge\":4},\"relation\":\"loop\",\"ids\":[4,0,2]}"},
    {.route = "list_halfedge_ring",
     .target = "/v1/meshes/kite/halfedges/4/ring",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"of\":{\"halfedge\":4},\"relation\":\"ring\",\"ids\":[4,3,6]}"},
    {.route = "list_edge_vertices",
     .target = "/v1/meshes/kite/edges/2/vertices",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"of\":{\"edge\":2},\"relation\":\"vertices\",\"ids\":[2,0]}"},
    {.route = "list_edge_halfedges",
     .target = "/v1/meshes/kite/edges/2/halfedges",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"of\":{\"edge\":2},\"relation\":\"halfedges\",\"ids\":[4,5]}"},
    {.route = "list_edge_faces",
     .target = "/v1/meshes/kite/edges/2/faces",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"of\":{\"edge\":2},\"relation\":\"faces\",\"ids\":[0,1]}"},
    {.route = "list_face_vertices",
     .target = "/v1/meshes/kite/faces/0/vertices",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"of\":{\"face\":0},\"relation\":\"vertices\",\"ids\":[0,1,2]}"},
    {.route = "list_face_halfedges",
     .target = "/v1/meshes/kite/faces/0/halfedges",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"of\":{\"face\":0},\"relation\":\"halfedges\",\"ids\":[0,2,4]}"},
    {.route = "list_face_edges",
     .target = "/v1/meshes/kite/faces/0/edges",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"of\":{\"face\":0},\"relation\":\"edges\",\"ids\":[0,1,2]}"},
    {.route = "list_face_faces",
     .target = "/v1/meshes/kite/faces/0/faces",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"of\":{\"face\":0},\"relation\":\"faces\",\"ids\":[1]}"},
    {.route = "query_mesh",
     .target = "/v1/meshes/kite/query",
     .consumes = "application/json",
     .request = "{\"queries\":[{\"relation\":\"faces\",\"of\":{\"vertex\":2}},"
                "{\"find\":\"halfedge\",\"vertices\":[0,2]},"
                "{\"find\":\"edge\",\"vertices\":[0,2]},"
                "{\"find\":\"faces\",\"vertices\":[0,2]},{\"get\":{\"face\":1}},"
                "{\"measure\":\"dihedral\",\"of\":{\"edge\":0}},"
                "{\"measure\":\"normal\",\"of\":{\"faces\":\"all\"}},"
                "{\"ray\":{\"origin\":[0,0.5,2],\"direction\":[0,0,-1]}},"
                "{\"closest\":[0,0.5,2],\"max\":1},{\"self_intersections\":{}}]}",
     .status = 200,
     .produces = "application/json",
     .response =
         "{\"revision\":1,\"results\":[{\"revision\":1,\"of\":{\"vertex\":2},"
         "\"relation\":\"faces\",\"ids\":[1,0]},{\"halfedge\":5},{\"edge\":2},{\"faces\":[0,1]},{"
         "\"id\":1,"
         "\"halfedge\":5,\"degree\":3,\"vertices\":[0,2,3],\"halfedges\":[5,6,8],"
         "\"area\":0.5,\"normal\":[0,0,1],\"centroid\":[0.3333333333333333,"
         "0.6666666666666666,0]},{\"revision\":1,\"of\":{\"edge\":0},\"measure\":\"dihedral\","
         "\"value\":null},{\"measure\":\"normal\",\"components\":3,\"values\":[[0,0,1],"
         "[0,0,1]]},{\"hit\":{\"face\":1,\"distance\":2,\"point\":[0,0.5,0],"
         "\"barycentric\":[{\"vertex\":0,\"weight\":0.5},{\"vertex\":3,"
         "\"weight\":0.5}]}},{\"closest\":null},{\"pairs\":[],\"total\":0,"
         "\"complete\":true}]}"},
    {.route = "traverse_mesh",
     .target = "/v1/meshes/kite/traverse",
     .consumes = "application/json",
     .request = "{\"walk\":\"path\",\"from\":{\"halfedge\":0},\"path\":[\"next\",\"next\","
                "\"twin\"]}",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"walk\":\"path\",\"from\":{\"halfedge\":0},\"path\":[\"next\","
                 "\"next\",\"twin\"],\"repeat\":1,\"halfedges\":[0,2,4,5],\"end\":5}"},
    {.route = "list_boundaries",
     .target = "/v1/meshes/kite/boundaries",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"loops\":[{\"halfedge\":1,\"length\":4,\"halfedges\":[1,9,7,"
                 "3],\"vertices\":[1,0,3,2]}]}"},
    {.route = "list_components",
     .target = "/v1/meshes/kite/components",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"by\":\"edge\",\"components\":[{\"faces\":2,\"vertices\":4,"
                 "\"face\":0}]}"},
    {.route = "check_mesh",
     .target = "/v1/meshes/kite/check?self_intersections=true&merge=0.5&flat=0.25",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":1,\"valid\":true,\"problems\":[],\"defects\":[],"
                 "\"totals\":{\"problems\":0,\"bowtie\":0,\"isolated_vertex\":0,"
                 "\"duplicate_position\":0,\"zero_length_edge\":0,\"degenerate_face\":0,"
                 "\"nonplanar_face\":0,\"small_component\":0,\"inside_out_component\":0,"
                 "\"self_intersection\":0},\"thresholds\":{\"merge\":0.5,\"flat\":0.25,"
                 "\"small\":0.014142135623730951},\"complete\":true}"},
    {.route = "apply_edits",
     .target = "/v1/meshes/kite/edits",
     .consumes = "application/json",
     .request = "{\"expected_revision\":1,\"ops\":[{\"op\":\"edge_split\",\"edge\":2,\"t\":0.5},"
                "{\"op\":\"vertex_move\",\"vertex\":1,\"to\":[1,0,0.25]}]}",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":2,\"results\":[{\"op\":\"edge_split\",\"vertex\":4,\"edges\":[5,"
                 "6,7],\"faces\":[2,3]},{\"op\":\"vertex_move\"}],\"created\":{\"vertices\":[4],"
                 "\"edges\":[5,6,7],\"faces\":[2,3]},\"deleted\":{\"vertices\":[],\"edges\":[],"
                 "\"faces\":[]},\"modified\":{\"vertices\":[1],\"edges\":[0,2,4],\"faces\":[0,"
                 "1]},\"parents\":{\"edges\":[[5,2]],\"faces\":[[2,0],[3,1]]},\"merged\":{}}"},
    {.route = "apply_edits",
     .target = "/v1/meshes/kite/edits",
     .consumes = "application/json",
     .request = "{\"op\":\"edge_flip\",\"edge\":0}",
     .status = 422,
     .produces = "application/problem+json",
     .response = "{\"type\":\"/problems/boundary_edge\",\"title\":\"The edge is on the boundary\""
                 ",\"status\":422,\"detail\":\"edge 0 has only one face\","
                 "\"code\":\"boundary_edge\",\"element\":{\"kind\":\"edge\",\"id\":0}}"},
    {.route = "list_edits",
     .target = "/v1/meshes/kite/edits",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":2,\"entries\":[{\"revision\":2,\"action\":\"edit\","
                 "\"ops\":[\"edge_split\",\"vertex_move\"],\"created\":{\"vertices\":1,"
                 "\"edges\":3,\"faces\":2},\"deleted\":{\"vertices\":0,\"edges\":0,"
                 "\"faces\":0},\"modified\":{\"vertices\":1,\"edges\":3,\"faces\":2},"
                 "\"undoable\":true,\"bytes\":952,"
                 "\"time\":\"2026-01-01T12:00:00.000Z\"}],\"undo\":1,\"redo\":0,\"oldest\":1,"
                 "\"dropped\":0,\"bytes\":1135,\"budget\":268435456,\"next\":null}"},
    {.route = "undo_edits",
     .target = "/v1/meshes/kite/undo",
     .consumes = "application/json",
     .request = "{\"expected_revision\":2}",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":3,\"results\":[],\"created\":{\"vertices\":[],\"edges\":[],"
                 "\"faces\":[]},\"deleted\":{\"vertices\":[4],\"edges\":[5,6,7],\"faces\":[2,3]},"
                 "\"modified\":{\"vertices\":[1],\"edges\":[0,2,4],\"faces\":[0,1]},"
                 "\"parents\":{},\"merged\":{},\"undo\":0,\"redo\":1}"},
    {.route = "redo_edits",
     .target = "/v1/meshes/kite/redo",
     .consumes = "application/json",
     .request = "{\"expected_revision\":3}",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":4,\"results\":[],\"created\":{\"vertices\":[4],\"edges\":[5,6,7],"
                 "\"faces\":[2,3]},\"deleted\":{\"vertices\":[],\"edges\":[],\"faces\":[]},"
                 "\"modified\":{\"vertices\":[1],\"edges\":[0,2,4],\"faces\":[0,1]},"
                 "\"parents\":{\"edges\":[[5,2]],\"faces\":[[2,0],[3,1]]},\"merged\":{},"
                 "\"undo\":1,\"redo\":0}"},
    {.route = "follow_mesh",
     .target = "/v1/meshes/kite/events?since=3",
     .status = 200,
     .produces = "text/event-stream",
     .response =
         "retry: 3000\n"
         "\n"
         "event: metadata\n"
         "data: {\"name\":\"Kite\"}\n"
         "\n"
         "id: 5d1b27c0e4a9f386.4\n"
         "event: edit\n"
         "data: {\"base\":3,\"revision\":4,\"action\":\"redo\",\"created\":{\"vertices\":[4]"
         ",\"edges\":[5,6,7],\"faces\":[2,3]},\"deleted\":{\"vertices\":[],\"edges\":[],\"f"
         "aces\":[]},\"modified\":{\"vertices\":[1],\"edges\":[0,2,4],\"faces\":[0,1]},\"p"
         "arents\":{\"edges\":[[5,2]],\"faces\":[[2,0],[3,1]]},\"merged\":{},\"values\":{"
         "\"vertices\":[[1,1,0,0.25,1],[4,0.5,0.5,0,10]],\"halfedges\":[[0,13,10,0,2"
         "],[2,4,12,1,0],[4,12,2,2,0],[5,6,14,4,1],[6,14,5,2,1],[8,11,15,3,3],[1"
         "0,0,13,4,2],[11,15,8,0,3],[12,2,4,4,0],[13,10,0,1,2],[14,5,6,3,1],[15,"
         "8,11,4,3]],\"faces\":[[0,12],[1,14],[2,10],[3,8]],\"attributes\":{}}}\n"
         "\n"
         "event: bye\n"
         "data: {\"reason\":\"stopping\"}\n"
         "\n"},
    {.route = "undo_edits",
     .target = "/v1/meshes/kite/undo",
     .consumes = "application/json",
     .request = "{\"to_revision\":1}",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":5,\"results\":[],\"created\":{\"vertices\":[],\"edges\":[],"
                 "\"faces\":[]},\"deleted\":{\"vertices\":[4],\"edges\":[5,6,7],\"faces\":[2,3]},"
                 "\"modified\":{\"vertices\":[1],\"edges\":[0,2,4],\"faces\":[0,1]},"
                 "\"parents\":{},\"merged\":{},\"undo\":0,\"redo\":1}"},
    {.route = "list_vertex_faces",
     .target = "/v1/meshes/kite/vertices/4/faces?revision=4",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":4,\"of\":{\"vertex\":4},\"relation\":\"faces\","
                 "\"ids\":[2,0,1,3]}"},
    {.route = "list_jobs",
     .target = "/v1/jobs",
     .status = 200,
     .produces = "application/json",
     .response =
         "{\"items\":[{\"id\":\"" API_EXAMPLE_JOB
         "\",\"operation\":\"create_mesh\",\"state\":\"done\",\"phase\":\"measuring\","
         "\"progress\":1,\"mesh\":\"disk\",\"created\":\"2026-01-01T12:00:00.000Z\","
         "\"started\":\"2026-01-01T12:00:00.000Z\",\"finished\":\"2026-01-01T12:00:00.000Z\","
         "\"status\":201,\"location\":\"/v1/meshes/disk\",\"result_link\":\"/v1/"
         "jobs/" API_EXAMPLE_JOB "/result\"},{\"id\":\"" API_EXAMPLE_WAITING
         "\",\"operation\":\"replace_mesh\",\"state\":\"queued\",\"phase\":null,\"progress\":0,"
         "\"mesh\":\"later\",\"created\":\"2026-01-01T12:00:00.000Z\",\"started\":null,"
         "\"finished\":null,\"status\":null,\"location\":null,\"result_link\":null}],\"next\":"
         "null}"},
    {.route = "get_job",
     .target = "/v1/jobs/" API_EXAMPLE_JOB,
     .status = 200,
     .produces = "application/json",
     .response =
         "{\"id\":\"" API_EXAMPLE_JOB
         "\",\"operation\":\"create_mesh\",\"state\":\"done\",\"phase\":\"measuring\","
         "\"progress\":1,\"mesh\":\"disk\",\"created\":\"2026-01-01T12:00:00.000Z\","
         "\"started\":\"2026-01-01T12:00:00.000Z\",\"finished\":\"2026-01-01T12:00:00.000Z\","
         "\"status\":201,\"location\":\"/v1/meshes/disk\",\"result_link\":\"/v1/"
         "jobs/" API_EXAMPLE_JOB "/result\",\"result\":{\"id\":\"disk\","
         "\"name\":\"\",\"revision\":1,\"counts\":{\"vertices\":4,\"halfedges\":12,\"edges\":6,"
         "\"faces\":3,\"boundary_loops\":1,\"isolated_vertices\":0,\"components\":1,"
         "\"components_by_edge\":1},\"euler\":1,\"genus\":0,\"closed\":false,\"manifold\":true,"
         "\"degrees\":{\"3\":3},\"bbox\":{\"min\":[-0.5,-0.8660254037844386,0],\"max\":[1,"
         "0.8660254037844386,0]},\"area\":1.299038105676658,\"volume\":null,\"memory_bytes\":408,"
         "\"created\":\"2026-01-01T12:00:00.000Z\",\"modified\":\"2026-01-01T12:00:00.000Z\","
         "\"import\":{\"format\":\"shape\",\"vertices\":4,\"faces\":3,\"repairs\":[],"
         "\"warnings\":[]}}}"},
    {.route = "get_job_result",
     .target = "/v1/jobs/" API_EXAMPLE_JOB "/result",
     .status = 200,
     .produces = "application/json",
     .response =
         "{\"id\":\"disk\","
         "\"name\":\"\",\"revision\":1,\"counts\":{\"vertices\":4,\"halfedges\":12,\"edges\":6,"
         "\"faces\":3,\"boundary_loops\":1,\"isolated_vertices\":0,\"components\":1,"
         "\"components_by_edge\":1},\"euler\":1,\"genus\":0,\"closed\":false,\"manifold\":true,"
         "\"degrees\":{\"3\":3},\"bbox\":{\"min\":[-0.5,-0.8660254037844386,0],\"max\":[1,"
         "0.8660254037844386,0]},\"area\":1.299038105676658,\"volume\":null,\"memory_bytes\":408,"
         "\"created\":\"2026-01-01T12:00:00.000Z\",\"modified\":\"2026-01-01T12:00:00.000Z\","
         "\"import\":{\"format\":\"shape\",\"vertices\":4,\"faces\":3,\"repairs\":[],"
         "\"warnings\":[]}}"},
    {.route = "delete_job",
     .target = "/v1/jobs/" API_EXAMPLE_WAITING,
     .status = 202,
     .produces = "application/json",
     .response =
         "{\"id\":\"" API_EXAMPLE_WAITING
         "\",\"operation\":\"replace_mesh\",\"state\":\"cancelled\",\"phase\":null,\"progress\":0,"
         "\"mesh\":\"later\",\"created\":\"2026-01-01T12:00:00.000Z\",\"started\":null,"
         "\"finished\":\"2026-01-01T12:00:00.000Z\",\"status\":null,\"location\":null,\"result_"
         "link\":null,"
         "\"problem\":null}"},
    {.route = "replace_attribute",
     .target = "/v1/meshes/kite/attributes/faces/selected",
     .consumes = "application/json",
     .request = "{\"type\":\"bool\"}",
     .status = 201,
     .produces = "application/json",
     .response = "{\"revision\":6,\"attribute\":{\"domain\":\"faces\",\"name\":\"selected\","
                 "\"type\":\"bool\",\"components\":1,\"rule\":\"copy\",\"default\":false,\"bytes\":"
                 "4},\"created\":{\"vertices\":[],\"edges\":[],\"faces\":[]},\"deleted\":{"
                 "\"vertices\":[],\"edges\":[],\"faces\":[]},\"modified\":{\"vertices\":[],"
                 "\"edges\":[],\"faces\":[]},\"parents\":{},\"merged\":{}}"},
    {.route = "update_attribute",
     .target = "/v1/meshes/kite/attributes/faces/selected",
     .consumes = "application/json",
     .request = "{\"ids\":[0,1],\"value\":true}",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":7,\"attribute\":{\"domain\":\"faces\",\"name\":\"selected\","
                 "\"type\":\"bool\",\"components\":1,\"rule\":\"copy\",\"default\":false,\"bytes\":"
                 "4},\"created\":{\"vertices\":[],\"edges\":[],\"faces\":[]},\"deleted\":{"
                 "\"vertices\":[],\"edges\":[],\"faces\":[]},\"modified\":{\"vertices\":[],"
                 "\"edges\":[],\"faces\":[0,1]},\"parents\":{},\"merged\":{}}"},
    {.route = "get_token",
     .target = "/v1/token",
     .status = 200,
     .produces = "application/json",
     .response = "{\"name\":null,\"role\":\"admin\",\"prefixes\":[],\"expires\":null}"},
    {.route = "create_ticket",
     .target = "/v1/tickets",
     .consumes = "application/json",
     .request = "{\"path\":\"/v1/meshes/kite/content?format=glb\"}",
     .status = 200,
     .produces = "application/json",
     .response = "{\"path\":\"/v1/meshes/kite/content?format=glb&ticket="
                 "hedge_p6Dq0wYzR2mXk8VtB4nHs1LcJf7GaEu9TiKo3CvQy5W\",\"expires\":"
                 "\"2026-01-01T12:00:00.000Z\"}"},
    {.route = "reload_tokens",
     .target = "/v1/admin/reload",
     .status = 200,
     .produces = "application/json",
     .response = "{\"tokens\":null}"},
    {.route = "list_materials",
     .target = "/v1/meshes/kite/materials",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":7,\"materials\":[]}"},
    {.route = "list_attributes",
     .target = "/v1/meshes/kite/attributes",
     .status = 200,
     .produces = "application/json",
     .response =
         "{\"revision\":7,\"attributes\":[{\"domain\":\"faces\",\"name\":\"selected\",\"type\":"
         "\"bool\",\"components\":1,\"rule\":\"copy\",\"default\":false,\"bytes\":4}]}"},
    {.route = "get_attribute",
     .target = "/v1/meshes/kite/attributes/faces/selected",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":7,\"domain\":\"faces\",\"name\":\"selected\",\"type\":\"bool\","
                 "\"components\":1,\"rule\":\"copy\",\"default\":false,\"bytes\":4,\"ids\":[0,1],"
                 "\"values\":[true,true],\"next\":null}"},
    {.route = "delete_attribute",
     .target = "/v1/meshes/kite/attributes/faces/selected",
     .status = 200,
     .produces = "application/json",
     .response = "{\"revision\":8,\"created\":{\"vertices\":[],\"edges\":[],\"faces\":[]},"
                 "\"deleted\":{\"vertices\":[],\"edges\":[],\"faces\":[]},\"modified\":{"
                 "\"vertices\":[],\"edges\":[],\"faces\":[]},\"parents\":{},\"merged\":{}}"},
};

enum { EXAMPLES = sizeof examples / sizeof *examples };

size_t api_example_count(void)
{
    return EXAMPLES;
}

const api_example *api_example_at(size_t i)
{
    return &examples[i];
}

const char *api_example_request(const char *route, const char *media)
{
    for (size_t i = 0; i < EXAMPLES; i++) {
        const api_example *row = &examples[i];
        if (row->status < 400 && row->request != NULL && strcmp(row->route, route) == 0 &&
            strcmp(row->consumes, media) == 0) {
            return row->request;
        }
    }
    return NULL;
}

const char *api_example_response(const char *route, const char *media)
{
    for (size_t i = 0; i < EXAMPLES; i++) {
        const api_example *row = &examples[i];
        if (row->status < 400 && strcmp(row->route, route) == 0 &&
            strcmp(row->produces, media) == 0) {
            return row->response;
        }
    }
    return NULL;
}

const char *api_example_problem(void)
{
    for (size_t i = 0; i < EXAMPLES; i++) {
        if (examples[i].status >= 400) {
            return examples[i].response;
        }
    }
    return NULL;
}
