// A mesh as the page's camera sees it; for the other shapes, the whole picture.
in vec3 rr_position, rr_vertex_normal;
uniform mat3 rr_turn_of_mesh;
uniform vec3 rr_eye_of_mesh;
uniform float rr_scale_of_mesh;
uniform int rr_shape_of_mesh;
out vec3 rr_point, rr_normal_of_mesh;

void main() {
    rr_point = rr_turn_of_mesh * rr_position;
    rr_normal_of_mesh = rr_turn_of_mesh * rr_vertex_normal;
    float depth = rr_eye_of_mesh.z - rr_point.z;
    gl_Position = rr_shape_of_mesh == 2
        ? vec4(rr_point.xy / rr_scale_of_mesh, (depth - 4.0) * 0.2 * depth, depth)
        : vec4(rr_position.xy, 0.0, 1.0);
}
