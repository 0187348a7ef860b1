// The built-in scene `seed` for POV-Ray 3.7, term by term the same shading where POV-Ray can express it.
//
// - Left-handed, window 5.333 x 4 at distance 5, as octray's camera.
// - POV-Ray's falloff is 2 / (1 + (d / fade_distance)^2): with a tiny fade distance f that is 2 f^2 / d^2 to 1 part in
//   10^6, so a light of intensity I has the colour I / (2 f^2).
// - POV-Ray multiplies ambient by the pigment: ambient is ka x background / kd.
// - `specular` with roughness 1/100 is Blinn's (N . H)^100.
// - Glass lets light through in POV-Ray's shadows; octray's shadows are hard whatever stands there. An unseen opaque
//   sphere just inside the glass casts that shadow.
#version 3.7;
global_settings {
  assumed_gamma 1.0
  max_trace_level 7
  adc_bailout 1/1024
}
#declare Sky = rgb <0.24, 0.34, 0.50>;
background { color Sky }

camera {
  perspective
  location <0, 0, -5>
  direction z * 5
  right x * 5.3333334
  up y * 4
}

#declare F = 0.001;
light_source { <-4, 5, -3> color rgb <1, 1, 1> * 56 / (2 * F * F) fade_distance F fade_power 2 }
light_source { <5, 4, -2> color rgb <1, 0.85, 0.6> * 34 / (2 * F * F) fade_distance F fade_power 2 }

#macro Matt(Ka, Kd, Ks)
  texture {
    pigment { rgb Kd }
    finish { ambient Ka * Sky / Kd diffuse 1 specular Ks roughness 0.01 }
  }
#end
#macro Metal(Ka, Kd, Ks, Tint)
  texture {
    pigment { rgb Kd }
    finish { ambient Ka * Sky / Kd diffuse 1 specular Ks roughness 0.01 reflection { rgb Tint * 0.9 } }
  }
#end
#declare Floor = Matt(<0.2, 0.2, 0.2>, <0.70, 0.68, 0.64>, 0)
#declare Wall = Matt(<0.2, 0.2, 0.2>, <0.45, 0.60, 0.55>, 0)
#declare Red = Matt(<0.2, 0.1, 0.1>, <0.80, 0.16, 0.14>, 0.35)
#declare Blue = Matt(<0.1, 0.1, 0.2>, <0.15, 0.25, 0.80>, 0.35)
#declare Green = Matt(<0.1, 0.2, 0.1>, <0.20, 0.65, 0.25>, 0.20)
#declare Steel = Metal(<0.05, 0.05, 0.05>, <0.10, 0.10, 0.11>, 0.6, <0.90, 0.90, 0.95>)
#declare Gold = Metal(<0.08, 0.06, 0.02>, <0.20, 0.14, 0.04>, 0.5, <0.95, 0.75, 0.35>)
#declare Glass = texture {
  pigment { rgbt 1 }
  finish { ambient 0 diffuse 0 specular 0.5 roughness 0.01 reflection { 0, 1 fresnel on } conserve_energy }
}

triangle { <-12, -1.5, -6>, <-12, -1.5, 9>, <12, -1.5, 9> texture { Floor } }
triangle { <-12, -1.5, -6>, <12, -1.5, 9>, <12, -1.5, -6> texture { Floor } }
triangle { <-12, -1.5, 9>, <-12, 4.2, 9>, <12, 4.2, 9> texture { Wall } }
triangle { <-12, -1.5, 9>, <12, 4.2, 9>, <12, -1.5, 9> texture { Wall } }
sphere { <-2.3, -0.70, 2.5>, 0.8 texture { Red } }
sphere { <0.2, -0.30, 4.0>, 1.2 texture { Steel } }
sphere { <-0.7, -0.80, 0.6>, 0.7 texture { Glass } interior { ior 1.5 } no_shadow }
sphere { <-0.7, -0.80, 0.6>, 0.6999 pigment { rgb 0 } no_image no_reflection }
sphere { <2.1, -0.95, 0.9>, 0.55 texture { Blue } }
sphere { <-3.4, 0.30, 5.5>, 1.0 texture { Gold } }
cylinder { <2.9, -1.5, 4.2>, <2.9, 0.5, 4.2>, 0.6 texture { Green } }
cylinder { <0.75, -1.5, 0.5>, <0.75, -0.8, 0.5>, 0.35 texture { Gold } }
