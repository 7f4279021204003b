// Fragment shader of the sky: a thin exponential atmosphere of dust over a black sky. Optical depth follows
// from the height where the ray passes lowest and a bounded air mass. An image, not radiometry.
layout(location = 0) in vec3 ray;
layout(location = LOCATION_UP) uniform vec3 up;
layout(location = LOCATION_ALTITUDE) uniform vec2 altitude;
layout(location = LOCATION_SUN) uniform vec3 sun;
layout(location = 0) out vec4 colour;
const float kScaleHeight = 11.0e3;
const float kZenithDepth = 0.25;

void main() {
  vec3 d = normalize(ray);
  float slope = dot(d, up);
  float h = max(altitude.x, 0.0);
  float r = altitude.y;
  // Height of the lowest point of the ray ahead; written without the difference of two radii.
  float lowest = h;
  if (slope < 0.0) {
    float drop = slope * slope * (r + h) / (1.0 + sqrt(max(1.0 - slope * slope, 0.0)));
    lowest = max(h - drop, -8.0e3);
  }
  float limb = sqrt(3.14159265 * r / (2.0 * kScaleHeight));
  float mass = 1.0 / (max(slope, 0.0) + 1.0 / limb);
  if (slope < 0.0) mass = mix(limb, 2.0 * limb, clamp((h - lowest) / kScaleHeight, 0.0, 1.0));
  float depth = kZenithDepth * exp(-lowest / kScaleHeight) * mass;
  float day = smoothstep(-0.15, 0.3, dot(sun, normalize(up * (r + h) + d * max(-slope, 0.0) * (r + h))));
  float glow = pow(max(dot(d, sun), 0.0), 24.0);
  vec3 dust = mix(vec3(0.83, 0.68, 0.53), vec3(0.93, 0.86, 0.80), glow);
  vec3 zenith = vec3(0.62, 0.48, 0.37);
  float veil = 1.0 - exp(-depth);
  vec3 air = mix(zenith, dust, clamp(depth * 0.5, 0.0, 1.0));
  vec3 c = air * veil * (0.08 + 0.92 * day);
  // 1 - cosine, which a cosine in float would lose.
  vec3 off = d - sun;
  float disc = 1.0 - smoothstep(5e-6, 1e-5, 0.5 * dot(off, off));
  c = mix(c, vec3(1.0, 0.98, 0.94), disc * exp(-0.3 * depth));
  colour = vec4(c, 1.0);
}
