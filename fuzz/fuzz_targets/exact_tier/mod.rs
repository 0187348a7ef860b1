//! The exact tier against rational arithmetic: no false hit, no false miss, and `t` to the last bits of an `f32`.

use octray::intersect::oracle::{self, Line, Shape};
use octray::intersect::{Curved, Exact, LaneHit, RayLanes, Tier, TriangleTest};
use octray::intersect::{cylinder, sphere};
use octray::math::Vec3;

/// Magnitudes whose products `f64` holds; what is smaller than the first has to be zero.
const DOMAIN: [f32; 2] = [1e-30, 1e18];

/// A ray and three points as the exact tier sees them.
pub struct Case {
    ray: RayLanes<f64>,
    points: [Vec3<f64>; 3],
    line: Line,
}

fn array(v: Vec3<f64>) -> [f64; 3] {
    [v.x, v.y, v.z]
}

impl Case {
    /// The case, if all numbers lie in the domain and the direction is one; its bounds are taken away.
    pub fn new(numbers: &[f32; 17], ray: &RayLanes<f32>, points: [Vec3<f32>; 3]) -> Option<Self> {
        let fits = |x: &f32| *x == 0.0 || (DOMAIN[0]..DOMAIN[1]).contains(&x.abs());
        let line = Line { origin: array(ray.origin.widen()), direction: array(ray.direction.widen()) };
        let all = numbers[..6].iter().chain(&numbers[8..]).all(fits);
        let ray = RayLanes { t_min: f64::NEG_INFINITY, t_max: f64::INFINITY, ..ray.widen() };
        let is_line = line.direction != [0.0; 3];
        (all && is_line).then_some(Self { ray, points: points.map(Vec3::widen), line })
    }

    /// Decided without rounding, edges and corners included.
    pub fn check_triangle(&self) {
        type Test = <Exact as Tier>::Triangle;
        let hit = Test::test(&self.ray, &Test::prepare(&self.ray), self.points, f64::INFINITY);
        let expected = oracle::triangle(&self.line, self.points.map(array));
        assert_eq!(hit.mask, expected.is_some(), "exact triangle: {:?} {:?}", self.line, self.points);
        if let Some(t) = expected {
            self.check_t("triangle", &hit, t);
        }
    }

    pub fn check_sphere(&self, s: &sphere::Lanes<f32>) {
        let (center, radius) = (array(s.center.widen()), f64::from(s.radius));
        let hit =
            <Exact as Tier>::Curved::sphere(&self.ray, &sphere::Lanes { center: s.center.widen(), radius });
        self.check_curved("sphere", &hit, &Shape::Sphere { center, radius });
    }

    /// **Needs:** an axis with a length.
    pub fn check_cylinder(&self, c: &cylinder::Lanes<f32>) {
        let (from, to, radius) = (c.from.widen(), c.to.widen(), f64::from(c.radius));
        let hit =
            <Exact as Tier>::Curved::cylinder(&self.ray, &cylinder::Lanes { from, to, radius, capped: true });
        let shape = oracle::Cylinder { from: array(from), to: array(to), radius, capped: true };
        self.check_curved("cylinder", &hit, &Shape::Cylinder(shape));
    }

    /// Decided without rounding, whatever is touched included.
    fn check_curved(&self, name: &str, hit: &LaneHit<f64>, shape: &Shape) {
        let expected = oracle::surfaces(&self.line, shape).iter().any(Option::is_some);
        assert_eq!(hit.mask, expected, "exact {name}: {:?} {shape:?}", self.line);
    }

    fn check_t(&self, name: &str, hit: &LaneHit<f64>, t: f64) {
        let (found, step) = (hit.t, f64::from(f32::EPSILON) * t.abs() + f64::from(f32::MIN_POSITIVE));
        assert!(
            (found - t).abs() <= step,
            "exact {name}: t {found:e} for {t:e}: {:?} {:?}",
            self.line,
            self.points
        );
    }
}
