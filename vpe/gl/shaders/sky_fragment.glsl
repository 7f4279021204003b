// Fragment shader of the sky, core::sky_colour(): a thin exponential atmosphere over a black sky. Optical depth
// follows from the height where the ray passes lowest and a bounded air mass. An image, not radiometry.
layout(location = 0) in vec3 ray;
layout(location = LOCATION_UP) uniform vec3 up;
layout(location = LOCATION_ALTITUDE) uniform vec2 altitude;
layout(location = LOCATION_SUN) uniform vec3 sun;
layout(location = LOCATION_AIR) uniform vec4 air;
layout(location = LOCATION_ZENITH) uniform vec3 zenith;
layout(location = LOCATION_DUST) uniform vec3 dust;
layout(location = LOCATION_GLOW) uniform vec3 glow;
layout(location = LOCATION_DISC) uniform vec3 disc;
layout(location = 0) out vec4 colour;

void main() {
  vec3 d = normalize(ray);
  float slope = dot(d, up);
  float h = max(altitude.x, 0.0);
  float r = altitude.y;
  // Height of the lowest point of the ray ahead; written without the difference of two radii.
  float lowest = h;
  if (slope < 0.0) {
    float drop = slope * slope * (r + h) / (1.0 + sqrt(max(1.0 - slope * slope, 0.0)));
    lowest = max(h - drop, air.w);
  }
  float limb = sqrt(3.14159265 * r / (2.0 * air.z));
  float mass = 1.0 / (max(slope, 0.0) + 1.0 / limb);
  if (slope < 0.0) mass = mix(limb, 2.0 * limb, clamp((h - lowest) / air.z, 0.0, 1.0));
  float thickness = exp(-lowest / air.z) * mass;
  float depth = air.x * thickness;
  float day = smoothstep(-0.15, 0.3, dot(sun, normalize(up * (r + h) + d * max(-slope, 0.0) * (r + h))));
  vec3 thick = mix(dust, glow, pow(max(dot(d, sun), 0.0), 24.0));
  float veil = 1.0 - exp(-depth);
  vec3 colours = mix(zenith, thick, clamp(depth * 0.5, 0.0, 1.0));
  vec3 c = colours * veil * (0.08 + 0.92 * day);
  // 1 - cosine, which a cosine in float would lose.
  vec3 off = d - sun;
  float shows = 1.0 - smoothstep(5e-6, 1e-5, 0.5 * dot(off, off));
  c = mix(c, disc, shows * exp(-air.y * thickness));
  colour = vec4(c, 1.0);
}
