//! Whether engines agree, before anything is timed.

use serde::{Deserialize, Serialize};

use super::classes::Question;
use super::engine::Answers;
use super::rays::{Hits, NO_HIT, RaySet};
use super::subject::Subject;
use crate::accel::brute;
use crate::intersect::{Ray, RayLanes, Tier, TierName};
use crate::math::{Real, Vec3};

/// Distances that differ by this share, of the distance or of a length of 1, are those of different hits.
const T_TOLERANCE: f32 = 1e-3;
/// Tests of one ray against one primitive that checking a class without a tree may cost.
const BRUTE_TESTS: usize = 30_000_000;
/// Most rays that are asked again without a tree.
const BRUTE_RAYS: usize = 256;

/// How the answers of two engines differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Difference {
    /// Rays of which one engine says that they hit and the other that they miss, or at clearly another distance.
    pub hits: usize,
    /// Rays that hit another primitive at nearly the same distance: where surfaces meet.
    pub primitives: usize,
}

/// Compares answers to the same rays.
pub fn difference(a: &Answers, b: &Answers) -> Difference {
    let mut found = Difference::default();
    found.hits += a.occluded.iter().zip(&b.occluded).filter(|(a, b)| a != b).count();
    for i in 0..a.hits.t.len() {
        let (prim_a, prim_b) = (a.hits.prim[i], b.hits.prim[i]);
        if is_other_hit(&a.hits, &b.hits, i) {
            found.hits += 1;
        } else if prim_a != prim_b {
            found.primitives += 1;
        }
    }
    found
}

fn is_other_hit(a: &Hits, b: &Hits, i: usize) -> bool {
    let (t, u) = (a.t[i], b.t[i]);
    match (a.prim[i] != NO_HIT, b.prim[i] != NO_HIT) {
        (true, true) => (t - u).abs() > T_TOLERANCE * t.abs().max(1.0),
        (hit_a, hit_b) => hit_a != hit_b,
    }
}

/// A number that tells answers apart: of the bits of all distances and the ids of all primitives.
///
/// **Source:** Fowler, Noll and Vo's hash FNV-1a, over words instead of bytes.
pub fn fingerprint(answers: &Answers) -> u64 {
    let hits = answers.hits.t.iter().zip(&answers.hits.prim);
    let hits = hits.flat_map(|(t, &prim)| [if prim == NO_HIT { 0 } else { t.to_bits() }, prim]);
    let words = hits.chain(answers.occluded.iter().map(|&is| u32::from(is)));
    words.fold(0xcbf2_9ce4_8422_2325, |hash: u64, word| {
        (hash ^ u64::from(word)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// A ray whose answer is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{engine}: ray {ray} {given}, but {expected} by {reference}: nothing is timed that is wrong")]
pub struct Mismatch {
    /// Name of the engine.
    pub engine: String,
    /// Number of the ray in its set.
    pub ray: usize,
    /// What the engine says.
    pub given: String,
    /// What is right.
    pub expected: String,
    /// Who says so.
    pub reference: &'static str,
}

/// Answers of octray in a tier against the plain traversal's.
///
/// **Errors:** the first ray that differs in any bit. The `Fast` tier does not promise as much: there one ray in a thousand
/// may be another hit.
pub fn agree(engine: &str, given: &Answers, plain: &Answers, tier: TierName) -> Result<(), Mismatch> {
    let differs = |i: &usize| match (tier, given.occluded.is_empty()) {
        (_, false) => given.occluded[*i] != plain.occluded[*i],
        (TierName::Fast, _) => is_other_hit(&given.hits, &plain.hits, *i),
        _ => !is_same_hit(&given.hits, &plain.hits, *i),
    };
    let rays = given.hits.t.len() + given.occluded.len();
    let allowed = if tier == TierName::Fast { rays / 1000 } else { 0 };
    match (0..rays).filter(differs).nth(allowed) {
        None => Ok(()),
        Some(ray) => Err(Mismatch {
            engine: engine.to_owned(),
            ray,
            given: told(given, ray),
            expected: told(plain, ray),
            reference: "the plain traversal",
        }),
    }
}

fn is_same_hit(a: &Hits, b: &Hits, i: usize) -> bool {
    a.prim[i] == b.prim[i] && (a.prim[i] == NO_HIT || a.t[i].to_bits() == b.t[i].to_bits())
}

fn told(answers: &Answers, i: usize) -> String {
    let Answers { hits, occluded } = answers;
    match (occluded.get(i), hits.prim.get(i)) {
        (Some(true), _) => "is blocked".into(),
        (Some(false), _) => "is free".into(),
        (None, Some(&prim)) if prim != NO_HIT => format!("hits primitive {prim:#x} at {}", hits.t[i]),
        _ => "hits nothing".into(),
    }
}

/// Some rays of a set, asked of every primitive without a tree.
#[derive(Clone, Debug, PartialEq)]
pub struct BruteForce {
    rays: Vec<usize>,
    hits: Vec<Option<(f32, u32)>>,
}

impl BruteForce {
    /// Asks as many rays, evenly spread over the set, as the size of the scene allows.
    pub fn of<T: Tier>(subject: &Subject, rays: &RaySet) -> Self {
        let affordable = (BRUTE_TESTS / subject.primitive_count().max(1)).clamp(8, BRUTE_RAYS);
        let chosen: Vec<usize> = (0..rays.len()).step_by(rays.len().div_ceil(affordable).max(1)).collect();
        let hit = |&i: &usize| {
            let found = brute::closest::<T>(&subject.geometry, &lone_ray::<T>(rays, i))?;
            Some((found.t.to_f32(), found.prim.0))
        };
        let hits = chosen.iter().map(hit).collect();
        Self { rays: chosen, hits }
    }
    /// How many rays were asked.
    pub fn len(&self) -> usize {
        self.rays.len()
    }
    /// True if none were.
    pub fn is_empty(&self) -> bool {
        self.rays.is_empty()
    }

    /// The same rays among the answers of an engine. **Errors:** the first ray that differs, as in [`agree`].
    pub fn agrees(
        &self,
        engine: &str,
        question: Question,
        given: &Answers,
        tier: TierName,
    ) -> Result<(), Mismatch> {
        let mut expected = Answers::new(question, self.rays.len());
        let mut chosen = expected.clone();
        for (place, (&ray, hit)) in self.rays.iter().zip(&self.hits).enumerate() {
            match question {
                Question::Any => {
                    expected.occluded[place] = hit.is_some();
                    chosen.occluded[place] = given.occluded[ray];
                }
                Question::Closest => {
                    let (t, prim) = hit.unwrap_or((0.0, NO_HIT));
                    (expected.hits.t[place], expected.hits.prim[place]) = (t, prim);
                    (chosen.hits.t[place], chosen.hits.prim[place]) =
                        (given.hits.t[ray], given.hits.prim[ray]);
                }
            }
        }
        agree(engine, &chosen, &expected, tier).map_err(|found| Mismatch {
            ray: self.rays[found.ray],
            reference: "testing every primitive",
            ..found
        })
    }
}

fn lone_ray<T: Tier>(rays: &RaySet, i: usize) -> RayLanes<T::Real> {
    let columns = rays.columns();
    let [origin, direction] = columns.ray(i);
    let ray = RayLanes::from(&Ray { origin, direction, t_min: rays.t_min[i], t_max: rays.t_max[i] });
    let real = T::Real::from_f32;
    let vector = |v: Vec3<f32>| Vec3 { x: real(v.x), y: real(v.y), z: real(v.z) };
    RayLanes {
        origin: vector(ray.origin),
        direction: vector(ray.direction),
        t_min: real(ray.t_min),
        t_max: real(ray.t_max),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::intersect::Watertight;
    use crate::measure::bench::engine::{Engine, ask};
    use crate::measure::bench::octray::Octray;
    use crate::measure::bench::testing::{Liar, subject};
    use crate::measure::bench::view::View;
    use crate::measure::bench::{Class, ray_set};

    fn answers(engine: &dyn Engine, question: Question, rays: &RaySet) -> Answers {
        let mut answers = Answers::new(question, rays.len());
        ask(engine, question, rays, &mut answers);
        answers
    }

    /// Answers of octray, the plain ones, and those of a liar about a ray that hits.
    fn three(subject: &Subject, question: Question, rays: &RaySet, off: f32) -> ([Answers; 3], usize) {
        let (octray, plain) =
            (Octray::<Watertight>::new(&subject.accel), Octray::<Watertight>::plain(&subject.accel));
        let honest = answers(&octray, Question::Closest, rays);
        let ray = honest.hits.prim.iter().position(|&prim| prim != NO_HIT).unwrap();
        let liar = Liar { honest: octray, ray, off };
        ([&octray as &dyn Engine, &plain, &liar].map(|engine| answers(engine, question, rays)), ray)
    }

    #[test]
    fn honest_answers_pass_and_one_lie_is_found() {
        let subject = subject("cornell", View::Scene);
        let rays = ray_set(&subject, Class::Primary, [64, 64]);
        let tier = TierName::Watertight;
        for question in [Question::Closest, Question::Any] {
            let ([honest, plain, lying], ray) = three(&subject, question, &rays, 1e-5);
            assert_eq!(agree("octray", &honest, &plain, tier), Ok(()));
            assert_eq!(difference(&honest, &plain), Difference::default());
            assert_eq!(fingerprint(&honest), fingerprint(&plain));
            let found = agree("liar", &lying, &plain, tier).unwrap_err();
            assert_eq!((found.ray, found.engine.as_str()), (ray, "liar"));
            assert_ne!(fingerprint(&lying), fingerprint(&plain));
        }
    }

    #[test]
    fn every_primitive_is_asked_for_some_rays() {
        let subject = subject("cornell", View::Scene);
        let rays = ray_set(&subject, Class::Primary, [16, 16]);
        let brute = BruteForce::of::<Watertight>(&subject, &rays);
        assert_eq!(brute.len(), 256);
        for question in [Question::Closest, Question::Any] {
            let ([honest, _, lying], ray) = three(&subject, question, &rays, 1e-5);
            assert_eq!(brute.agrees("octray", question, &honest, TierName::Watertight), Ok(()));
            let found = brute.agrees("liar", question, &lying, TierName::Watertight).unwrap_err();
            assert_eq!((found.ray, found.reference), (ray, "testing every primitive"));
        }
    }

    #[test]
    fn other_ray_tracers_may_round_but_not_miss() {
        let subject = subject("cornell", View::Scene);
        let rays = ray_set(&subject, Class::Primary, [16, 16]);
        let differs = |off| {
            let ([honest, _, lying], _) = three(&subject, Question::Closest, &rays, off);
            difference(&honest, &lying).hits
        };
        assert_eq!((differs(1e-5), differs(10.0)), (0, 1));
        let ([honest, _, mut other], ray) = three(&subject, Question::Closest, &rays, 0.0);
        other.hits.prim[ray] ^= 1;
        assert_eq!(difference(&honest, &other), Difference { hits: 0, primitives: 1 });
        other.hits.prim[ray] = NO_HIT;
        assert_eq!(difference(&honest, &other), Difference { hits: 1, primitives: 0 });
    }
}
