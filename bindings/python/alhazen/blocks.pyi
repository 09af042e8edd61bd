"""All blocks of the native scene format; made by bindings/python/tools/make_stubs.py."""
from typing import Any, List, Sequence, Union

from ._blocks import Block as Block, Call as Call, Word as Word

__all__: List[str]

def translate(x: float, y: float, z: float) -> Call: ...
def rotate(axis: Sequence[float], degrees: float) -> Call: ...
def scale(*factors: float) -> Call: ...
def matrix(rows: Any) -> Call: ...
def texture_input(name: str, factor: Any = ..., channel: str = ...) -> Call: ...

def picture(label: Union[str, Block] = ..., *items: Block, width: Any = ..., height: Any = ..., background: Any = ...,
            shutter: Any = ..., up_axis: Any = ...) -> Block:
    """A block ``picture`` of a scene; keys:

    - width
    - height
    - background
    - shutter
    - up_axis: one of y, z"""

def environment(label: Union[str, Block] = ..., *items: Block, kind: Any = ..., color: Any = ..., ground: Any = ...,
                scale: Any = ..., rotation_deg: Any = ..., rotation_rad: Any = ..., turbidity: Any = ...,
                up: Any = ..., to_sun: Any = ..., file: Any = ...) -> Block:
    """A block ``environment`` of a scene; keys:

    - kind: one of constant, picture, sky, studio; required
    - color
    - ground
    - scale
    - rotation_deg
    - rotation_rad
    - turbidity
    - up
    - to_sun
    - file"""

def conventions(label: Union[str, Block] = ..., *items: Block, highlight: Any = ..., shadow_tint: Any = ...,
                refraction_tint: Any = ..., ambient_factor: Any = ..., ambient_inside_times_kt: Any = ...,
                ambient_from_eye: Any = ..., clamp_attenuation: Any = ..., truncate_material_colors: Any = ...,
                transmitting_surfaces_reflect: Any = ..., trace_reflections: Any = ..., trace_refractions: Any = ...,
                correct_interpolated_normals: Any = ..., headlight: Any = ..., surroundings: Any = ...,
                air_index: Any = ..., min_distance: Any = ..., pixel_sample: Any = ..., linear_output: Any = ...,
                round_output: Any = ..., max_depth: Any = ..., min_contribution: Any = ...) -> Block:
    """A block ``conventions`` of a scene; keys:

    - highlight: one of phong, blinn_phong, schlick
    - shadow_tint: one of per_crossing, per_distance, opaque, none
    - refraction_tint: one of per_event, per_distance
    - ambient_factor: one of ambient, diffuse
    - ambient_inside_times_kt
    - ambient_from_eye
    - clamp_attenuation
    - truncate_material_colors
    - transmitting_surfaces_reflect
    - trace_reflections
    - trace_refractions
    - correct_interpolated_normals
    - headlight
    - surroundings
    - air_index
    - min_distance
    - pixel_sample: one of center, lower_left_corner, frame_corners
    - linear_output
    - round_output
    - max_depth
    - min_contribution"""

def perspective_camera(label: Union[str, Block] = ..., *items: Block, eye: Any = ..., look_at: Any = ...,
                       direction: Any = ..., up: Any = ..., aspect: Any = ..., fov_deg: Any = ...,
                       lens_radius: Any = ..., blades: Any = ..., blade_turn_deg: Any = ...,
                       blade_turn_rad: Any = ..., focus_distance: Any = ..., focus_at: Any = ...,
                       motion: Any = ...) -> Block:
    """A block ``perspective_camera`` of a scene; keys:

    - eye: required
    - look_at
    - direction
    - up
    - aspect
    - fov_deg
    - lens_radius
    - blades
    - blade_turn_deg
    - blade_turn_rad
    - focus_distance
    - focus_at
    - motion"""

def sheared_camera(label: Union[str, Block] = ..., *items: Block, eye: Any = ..., look: Any = ..., right: Any = ...,
                   up: Any = ..., aspect: Any = ..., lens_radius: Any = ..., blades: Any = ...,
                   blade_turn_deg: Any = ..., blade_turn_rad: Any = ..., focus_distance: Any = ...,
                   focus_at: Any = ..., motion: Any = ...) -> Block:
    """A block ``sheared_camera`` of a scene; keys:

    - eye: required
    - look: required
    - right: required
    - up: required
    - aspect: required
    - lens_radius
    - blades
    - blade_turn_deg
    - blade_turn_rad
    - focus_distance
    - focus_at
    - motion"""

def orthographic_camera(label: Union[str, Block] = ..., *items: Block, eye: Any = ..., look_at: Any = ...,
                        direction: Any = ..., up: Any = ..., aspect: Any = ..., height: Any = ...,
                        motion: Any = ...) -> Block:
    """A block ``orthographic_camera`` of a scene; keys:

    - eye: required
    - look_at
    - direction
    - up
    - aspect
    - height: required
    - motion"""

def sheared_orthographic_camera(label: Union[str, Block] = ..., *items: Block, eye: Any = ..., direction: Any = ...,
                                right: Any = ..., up: Any = ..., aspect: Any = ..., motion: Any = ...) -> Block:
    """A block ``sheared_orthographic_camera`` of a scene; keys:

    - eye: required
    - direction: required
    - right: required
    - up: required
    - aspect: required
    - motion"""

def ambient_light(label: Union[str, Block] = ..., *items: Block, color: Any = ...) -> Block:
    """A block ``ambient_light`` of a scene; keys:

    - color: required"""

def directional_light(label: Union[str, Block] = ..., *items: Block, direction: Any = ..., to_light: Any = ...,
                      color: Any = ..., ambient: Any = ..., glints: Any = ...) -> Block:
    """A block ``directional_light`` of a scene; keys:

    - direction
    - to_light
    - color
    - ambient
    - glints"""

def point_light(label: Union[str, Block] = ..., *items: Block, position: Any = ..., color: Any = ...,
                ambient: Any = ..., attenuation: Any = ..., range: Any = ..., glints: Any = ...,
                profile_down: Any = ..., profile_front: Any = ..., profile: Any = ..., power_watts: Any = ...,
                lumens: Any = ...) -> Block:
    """A block ``point_light`` of a scene; keys:

    - position: required
    - color
    - ambient
    - attenuation
    - range
    - glints
    - profile_down
    - profile_front
    - profile
    - power_watts
    - lumens"""

def spot_light(label: Union[str, Block] = ..., *items: Block, position: Any = ..., look_at: Any = ...,
               direction: Any = ..., inner_angle_deg: Any = ..., inner_angle_rad: Any = ...,
               outer_angle_deg: Any = ..., outer_angle_rad: Any = ..., color: Any = ..., ambient: Any = ...,
               attenuation: Any = ..., range: Any = ..., profile_down: Any = ..., profile_front: Any = ...,
               profile: Any = ...) -> Block:
    """A block ``spot_light`` of a scene; keys:

    - position: required
    - look_at
    - direction
    - inner_angle_deg
    - inner_angle_rad
    - outer_angle_deg
    - outer_angle_rad
    - color
    - ambient
    - attenuation
    - range
    - profile_down
    - profile_front
    - profile"""

def rectangle_light(label: Union[str, Block] = ..., *items: Block, corner: Any = ..., edge_u: Any = ...,
                    edge_v: Any = ..., radiance: Any = ..., ambient: Any = ..., two_sided: Any = ..., seen: Any = ...,
                    power_watts: Any = ..., lumens: Any = ...) -> Block:
    """A block ``rectangle_light`` of a scene; keys:

    - corner: required
    - edge_u: required
    - edge_v: required
    - radiance: required
    - ambient
    - two_sided
    - seen
    - power_watts
    - lumens"""

def disc_light(label: Union[str, Block] = ..., *items: Block, center: Any = ..., normal: Any = ..., radius: Any = ...,
               inner_radius: Any = ..., radiance: Any = ..., ambient: Any = ..., two_sided: Any = ...,
               seen: Any = ..., power_watts: Any = ..., lumens: Any = ...) -> Block:
    """A block ``disc_light`` of a scene; keys:

    - center: required
    - normal: required
    - radius: required
    - inner_radius
    - radiance: required
    - ambient
    - two_sided
    - seen
    - power_watts
    - lumens"""

def sphere_light(label: Union[str, Block] = ..., *items: Block, center: Any = ..., radius: Any = ...,
                 radiance: Any = ..., ambient: Any = ..., two_sided: Any = ..., seen: Any = ...,
                 power_watts: Any = ..., lumens: Any = ...) -> Block:
    """A block ``sphere_light`` of a scene; keys:

    - center: required
    - radius: required
    - radiance: required
    - ambient
    - two_sided
    - seen
    - power_watts
    - lumens"""

def tube_light(label: Union[str, Block] = ..., *items: Block, base: Any = ..., top: Any = ..., radius: Any = ...,
               radiance: Any = ..., ambient: Any = ..., two_sided: Any = ..., seen: Any = ..., power_watts: Any = ...,
               lumens: Any = ...) -> Block:
    """A block ``tube_light`` of a scene; keys:

    - base: required
    - top: required
    - radius: required
    - radiance: required
    - ambient
    - two_sided
    - seen
    - power_watts
    - lumens"""

def polygon_light(label: Union[str, Block] = ..., *items: Block, vertices: Any = ..., radiance: Any = ...,
                  ambient: Any = ..., two_sided: Any = ..., seen: Any = ..., power_watts: Any = ...,
                  lumens: Any = ...) -> Block:
    """A block ``polygon_light`` of a scene; keys:

    - vertices: required
    - radiance: required
    - ambient
    - two_sided
    - seen
    - power_watts
    - lumens"""

def mesh_light(label: Union[str, Block] = ..., *items: Block, points: Any = ..., faces: Any = ...,
               radiance: Any = ..., ambient: Any = ..., two_sided: Any = ..., seen: Any = ..., power_watts: Any = ...,
               lumens: Any = ...) -> Block:
    """A block ``mesh_light`` of a scene; keys:

    - points: required
    - faces: required
    - radiance: required
    - ambient
    - two_sided
    - seen
    - power_watts
    - lumens"""

def material(label: Union[str, Block] = ..., *items: Block, name: Any = ..., emission: Any = ..., ambient: Any = ...,
             diffuse: Any = ..., specular: Any = ..., reflective: Any = ..., transmissive: Any = ...,
             shininess: Any = ..., roughness: Any = ..., index: Any = ..., density: Any = ..., alpha_mode: Any = ...,
             alpha: Any = ..., alpha_cutoff: Any = ..., double_sided: Any = ..., normal_map: Any = ...,
             metallic_roughness: Any = ..., conductor: Any = ..., dielectric: Any = ...) -> Block:
    """A block ``material`` of a scene; keys:

    - name
    - emission
    - ambient
    - diffuse
    - specular
    - reflective
    - transmissive
    - shininess
    - roughness
    - index
    - density
    - alpha_mode: one of opaque, mask, blend
    - alpha
    - alpha_cutoff
    - double_sided
    - normal_map
    - metallic_roughness
    - conductor
    - dielectric"""

def texture(label: Union[str, Block] = ..., *items: Block, file: Any = ..., name: Any = ..., wrap_u: Any = ...,
            wrap_v: Any = ..., filter: Any = ..., bilinear: Any = ..., corner_texels: Any = ..., uv_set: Any = ...,
            uv_transform: Any = ..., srgb: Any = ...) -> Block:
    """A block ``texture`` of a scene; keys:

    - file: required
    - name
    - wrap_u: one of repeat, clamp, mirror
    - wrap_v: one of repeat, clamp, mirror
    - filter: one of nearest, bilinear, mipmapped
    - bilinear
    - corner_texels
    - uv_set
    - uv_transform
    - srgb"""

def solid_texture(label: Union[str, Block] = ..., *items: Block, kind: Any = ..., name: Any = ..., color: Any = ...,
                  other: Any = ..., origin: Any = ..., size: Any = ..., direction: Any = ..., octaves: Any = ...,
                  turbulence: Any = ...) -> Block:
    """A block ``solid_texture`` of a scene; keys:

    - kind: one of checks, stripes, noise, marble, wood; required
    - name
    - color
    - other
    - origin
    - size
    - direction
    - octaves
    - turbulence"""

def instance(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
             visible_to: Any = ..., name: Any = ...) -> Block:
    """A block ``instance`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - name"""

def geometry(label: Union[str, Block] = ..., *items: Block, name: Any = ..., file: Any = ..., points: Any = ...,
             faces: Any = ..., normals: Any = ..., uvs: Any = ..., vertex_materials: Any = ..., smooth: Any = ...,
             point_keys: Any = ...) -> Block:
    """A block ``geometry`` of a scene; keys:

    - name
    - file
    - points: required
    - faces: required
    - normals
    - uvs
    - vertex_materials
    - smooth
    - point_keys"""

def mesh(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
         visible_to: Any = ..., geometry: Any = ..., file: Any = ..., points: Any = ..., faces: Any = ...,
         normals: Any = ..., uvs: Any = ..., vertex_materials: Any = ..., smooth: Any = ..., point_keys: Any = ...,
         material: Any = ...) -> Block:
    """A block ``mesh`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - geometry
    - file
    - points: required
    - faces: required
    - normals
    - uvs
    - vertex_materials
    - smooth
    - point_keys
    - material"""

def group(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., visible_to: Any = ...,
          material: Any = ...) -> Block:
    """A block ``group`` of a scene; keys:

    - transform
    - visible_to
    - material"""

def union(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
          visible_to: Any = ..., material: Any = ...) -> Block:
    """A block ``union`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - material"""

def intersection(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
                 visible_to: Any = ..., material: Any = ...) -> Block:
    """A block ``intersection`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - material"""

def difference(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
               visible_to: Any = ..., cut_material: Any = ..., material: Any = ...) -> Block:
    """A block ``difference`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - cut_material: one of own, minuend
    - material"""

def objects(label: Union[str, Block] = ..., *items: Block, names: Any = ..., root: Any = ..., root_name: Any = ...,
            combine: Any = ..., cut_material: Any = ...) -> Block:
    """A block ``objects`` of a scene; keys:

    - names: required
    - root: required
    - root_name
    - combine: one of group, union, intersection, difference
    - cut_material: one of own, minuend"""

def object(label: Union[str, Block] = ..., *items: Block, material: Any = ..., name: Any = ..., combine: Any = ...,
           cut_material: Any = ..., accelerator: Any = ...) -> Block:
    """A block ``object`` of a scene; keys:

    - material
    - name
    - combine: one of group, union, intersection, difference
    - cut_material: one of own, minuend
    - accelerator"""

def defaults(label: Union[str, Block] = ..., *items: Block, material: Any = ...) -> Block:
    """A block ``defaults`` of a scene; keys:

    - material"""

def sphere(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
           visible_to: Any = ..., center: Any = ..., radius: Any = ..., material: Any = ...) -> Block:
    """A shape ``sphere`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - center: point, scene units; default (0, 0, 0)
    - radius: scene units; default 1
    - material"""

def plane(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
          visible_to: Any = ..., point: Any = ..., normal: Any = ..., material: Any = ...) -> Block:
    """A shape ``plane`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - point: point, scene units; default (0, 0, 0)
    - normal: vector of any length; default (0, 0, 1)
    - material"""

def disc(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
         visible_to: Any = ..., center: Any = ..., normal: Any = ..., radius: Any = ..., inner_radius: Any = ...,
         material: Any = ...) -> Block:
    """A shape ``disc`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - center: point, scene units; default (0, 0, 0)
    - normal: vector of any length; default (0, 0, 1)
    - radius: scene units; default 1
    - inner_radius: scene units; default 0
    - material"""

def rectangle(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
              visible_to: Any = ..., corner: Any = ..., edge_u: Any = ..., edge_v: Any = ...,
              material: Any = ...) -> Block:
    """A shape ``rectangle`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - corner: point, scene units; default (-0.5, -0.5, 0)
    - edge_u: vector, scene units; default (1, 0, 0)
    - edge_v: vector, scene units; default (0, 1, 0)
    - material"""

def box(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ..., visible_to: Any = ...,
        lo: Any = ..., hi: Any = ..., material: Any = ...) -> Block:
    """A shape ``box`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - lo: point, scene units; default (-0.5, -0.5, -0.5)
    - hi: point, scene units; default (0.5, 0.5, 0.5)
    - material"""

def cylinder(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
             visible_to: Any = ..., base: Any = ..., top: Any = ..., radius: Any = ..., capped: Any = ...,
             material: Any = ...) -> Block:
    """A shape ``cylinder`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - base: point, scene units; default (0, 0, 0)
    - top: point, scene units; default (0, 0, 1)
    - radius: scene units; default 1
    - capped: bool; default true
    - material"""

def cone(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
         visible_to: Any = ..., base: Any = ..., top: Any = ..., base_radius: Any = ..., top_radius: Any = ...,
         capped: Any = ..., material: Any = ...) -> Block:
    """A shape ``cone`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - base: point, scene units; default (0, 0, 0)
    - top: point, scene units; default (0, 0, 1)
    - base_radius: scene units; default 1
    - top_radius: scene units; default 0
    - capped: bool; default true
    - material"""

def polygon(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
            visible_to: Any = ..., vertices: Any = ..., loops: Any = ..., material: Any = ...) -> Block:
    """A shape ``polygon`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - vertices: list
    - loops
    - material"""

def half_space(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
               visible_to: Any = ..., point: Any = ..., normal: Any = ..., material: Any = ...) -> Block:
    """A shape ``half_space`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - point: point, scene units; default (0, 0, 0)
    - normal: vector of any length; default (0, 0, 1)
    - material"""

def polyhedron(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
               visible_to: Any = ..., planes: Any = ..., vertices: Any = ..., faces: Any = ...,
               material: Any = ...) -> Block:
    """A shape ``polyhedron`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - planes: list
    - vertices: list
    - faces
    - material"""

def ellipsoid(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
              visible_to: Any = ..., center: Any = ..., axis_a: Any = ..., axis_b: Any = ..., axis_c: Any = ...,
              material: Any = ...) -> Block:
    """A shape ``ellipsoid`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - center: point, scene units; default (0, 0, 0)
    - axis_a: vector, scene units; default (1, 0, 0)
    - axis_b: vector, scene units; default (0, 1, 0)
    - axis_c: vector, scene units; default (0, 0, 1)
    - material"""

def elliptic_cylinder(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
                      visible_to: Any = ..., base: Any = ..., top: Any = ..., axis_a: Any = ..., axis_b: Any = ...,
                      capped: Any = ..., material: Any = ...) -> Block:
    """A shape ``elliptic_cylinder`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - base: point, scene units; default (0, 0, 0)
    - top: point, scene units; default (0, 0, 1)
    - axis_a: vector, scene units; default (1, 0, 0)
    - axis_b: vector, scene units; default (0, 1, 0)
    - capped: bool; default true
    - material"""

def elliptic_cone(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
                  visible_to: Any = ..., base: Any = ..., top: Any = ..., axis_a: Any = ..., axis_b: Any = ...,
                  top_scale: Any = ..., capped: Any = ..., material: Any = ...) -> Block:
    """A shape ``elliptic_cone`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - base: point, scene units; default (0, 0, 0)
    - top: point, scene units; default (0, 0, 1)
    - axis_a: vector, scene units; default (1, 0, 0)
    - axis_b: vector, scene units; default (0, 1, 0)
    - top_scale: number; default 0
    - capped: bool; default true
    - material"""

def tgc(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ..., visible_to: Any = ...,
        base: Any = ..., height: Any = ..., axis_a: Any = ..., axis_b: Any = ..., axis_c: Any = ...,
        axis_d: Any = ..., capped: Any = ..., material: Any = ...) -> Block:
    """A shape ``tgc`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - base: point, scene units; default (0, 0, 0)
    - height: vector, scene units; default (0, 0, 1)
    - axis_a: vector, scene units; default (1, 0, 0)
    - axis_b: vector, scene units; default (0, 1, 0)
    - axis_c: vector, scene units; default (1, 0, 0)
    - axis_d: vector, scene units; default (0, 1, 0)
    - capped: bool; default true
    - material"""

def torus(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
          visible_to: Any = ..., center: Any = ..., axis: Any = ..., major_radius: Any = ..., minor_radius: Any = ...,
          material: Any = ...) -> Block:
    """A shape ``torus`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - center: point, scene units; default (0, 0, 0)
    - axis: vector of any length; default (0, 0, 1)
    - major_radius: scene units; default 1
    - minor_radius: scene units; default 0.25
    - material"""

def paraboloid(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
               visible_to: Any = ..., apex: Any = ..., rim: Any = ..., axis_a: Any = ..., axis_b: Any = ...,
               capped: Any = ..., material: Any = ...) -> Block:
    """A shape ``paraboloid`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - apex: point, scene units; default (0, 0, 0)
    - rim: point, scene units; default (0, 0, 1)
    - axis_a: vector, scene units; default (1, 0, 0)
    - axis_b: vector, scene units; default (0, 1, 0)
    - capped: bool; default true
    - material"""

def hyperboloid(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
                visible_to: Any = ..., base: Any = ..., top: Any = ..., axis_a: Any = ..., axis_b: Any = ...,
                waist: Any = ..., capped: Any = ..., material: Any = ...) -> Block:
    """A shape ``hyperboloid`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - base: point, scene units; default (0, 0, -1)
    - top: point, scene units; default (0, 0, 1)
    - axis_a: vector, scene units; default (1, 0, 0)
    - axis_b: vector, scene units; default (0, 1, 0)
    - waist: number; default 0.5
    - capped: bool; default true
    - material"""

def two_sheet_hyperboloid(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
                          visible_to: Any = ..., base: Any = ..., top: Any = ..., axis_a: Any = ...,
                          axis_b: Any = ..., gap: Any = ..., capped: Any = ..., material: Any = ...) -> Block:
    """A shape ``two_sheet_hyperboloid`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - base: point, scene units; default (0, 0, -1)
    - top: point, scene units; default (0, 0, 1)
    - axis_a: vector, scene units; default (1, 0, 0)
    - axis_b: vector, scene units; default (0, 1, 0)
    - gap: number; default 0.25
    - capped: bool; default true
    - material"""

def quadric(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
            visible_to: Any = ..., squares: Any = ..., products: Any = ..., linear: Any = ..., constant: Any = ...,
            clip_box: Any = ..., clip_planes: Any = ..., capped: Any = ..., material: Any = ...) -> Block:
    """A shape ``quadric`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - squares: number; default (1, 1, 1)
    - products: number; default (0, 0, 0)
    - linear: number; default (0, 0, 0)
    - constant: number; default -1
    - clip_box: list
    - clip_planes: list
    - capped: bool; default true
    - material"""

def algebraic(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
              visible_to: Any = ..., expression: Any = ..., clip_box: Any = ..., capped: Any = ...,
              material: Any = ...) -> Block:
    """A shape ``algebraic`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - expression: text
    - clip_box: list
    - capped: bool; default true
    - material"""

def superellipsoid(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
                   visible_to: Any = ..., center: Any = ..., axis_a: Any = ..., axis_b: Any = ..., axis_c: Any = ...,
                   east: Any = ..., north: Any = ..., material: Any = ...) -> Block:
    """A shape ``superellipsoid`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - center: point, scene units; default (0, 0, 0)
    - axis_a: vector, scene units; default (1, 0, 0)
    - axis_b: vector, scene units; default (0, 1, 0)
    - axis_c: vector, scene units; default (0, 0, 1)
    - east: number; default 1
    - north: number; default 1
    - material"""

def prism(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
          visible_to: Any = ..., profile: Any = ..., loops: Any = ..., h0: Any = ..., h1: Any = ...,
          top_scale: Any = ..., material: Any = ...) -> Block:
    """A shape ``prism`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - profile: list
    - loops
    - h0: scene units; default 0
    - h1: scene units; default 1
    - top_scale: number; default 1
    - material"""

def lathe(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
          visible_to: Any = ..., profile: Any = ..., loops: Any = ..., material: Any = ...) -> Block:
    """A shape ``lathe`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - profile: list
    - loops
    - material"""

def blob(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
         visible_to: Any = ..., threshold: Any = ..., components: Any = ..., material: Any = ...) -> Block:
    """A shape ``blob`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - threshold: number; default 0.5
    - components: list; required
    - material"""

def height_field(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
                 visible_to: Any = ..., lo: Any = ..., hi: Any = ..., base: Any = ..., heights: Any = ...,
                 file: Any = ..., material: Any = ...) -> Block:
    """A shape ``height_field`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - lo: point, scene units; default (0, 0)
    - hi: point, scene units; default (1, 1)
    - base: scene units; default -1
    - heights: list
    - file
    - material"""

def bezier_patch(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
                 visible_to: Any = ..., degree_u: Any = ..., degree_v: Any = ..., points: Any = ...,
                 weights: Any = ..., material: Any = ...) -> Block:
    """A shape ``bezier_patch`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - degree_u: whole number; default 3
    - degree_v: whole number; default 3
    - points: list
    - weights: list
    - material"""

def patch_mesh(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
               visible_to: Any = ..., degree_u: Any = ..., degree_v: Any = ..., points: Any = ..., weights: Any = ...,
               patches: Any = ..., material: Any = ...) -> Block:
    """A shape ``patch_mesh`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - degree_u: whole number; default 3
    - degree_v: whole number; default 3
    - points: list
    - weights: list
    - patches: list
    - material"""

def nurbs_surface(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
                  visible_to: Any = ..., degree_u: Any = ..., degree_v: Any = ..., knots_u: Any = ...,
                  knots_v: Any = ..., points: Any = ..., weights: Any = ..., trims: Any = ...,
                  material: Any = ...) -> Block:
    """A shape ``nurbs_surface`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - degree_u: whole number; default 3
    - degree_v: whole number; default 3
    - knots_u: list
    - knots_v: list
    - points: list
    - weights: list
    - trims: list
    - material"""

def bilinear_patch(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
                   visible_to: Any = ..., p00: Any = ..., p10: Any = ..., p01: Any = ..., p11: Any = ...,
                   material: Any = ...) -> Block:
    """A shape ``bilinear_patch`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - p00: point, scene units; default (0, 0, 0)
    - p10: point, scene units; default (1, 0, 0)
    - p01: point, scene units; default (0, 1, 0)
    - p11: point, scene units; default (1, 1, 0)
    - material"""

def steiner_patch(label: Union[str, Block] = ..., *items: Block, transform: Any = ..., motion: Any = ...,
                  visible_to: Any = ..., points: Any = ..., weights: Any = ..., material: Any = ...) -> Block:
    """A shape ``steiner_patch`` of a scene; keys:

    - transform
    - motion
    - visible_to
    - points: list
    - weights: list
    - material"""
