//! Hardware counters of the calling thread, where processor and kernel have them.

use serde::{Deserialize, Serialize};

/// What counters said, a ray.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CounterReading {
    /// Cycles of the core.
    pub cycles: f64,
    /// Instructions retired.
    pub instructions: f64,
    /// Branches predicted wrong.
    pub branch_misses: f64,
    /// References that missed the last cache.
    pub cache_misses: f64,
}

/// Counters that can be read around some work.
pub struct Counters(imp::Group);

impl Counters {
    /// Opens the counters of this thread. **Errors:** why there are none, in one line.
    pub fn open() -> Result<Self, String> {
        imp::open().map(Self)
    }
    /// Runs `work`, which asks `rays` rays, on this thread. `None` where the counters had to share the processor with
    /// others and were not counting all the time.
    pub fn around(&mut self, rays: usize, work: impl FnOnce()) -> Option<CounterReading> {
        imp::around(&mut self.0, rays, work)
    }
}

#[cfg(target_os = "linux")]
mod imp {
    use perf_event::events::Hardware;
    use perf_event::{Builder, Counter, Group as PerfGroup};

    use super::CounterReading;

    pub(super) struct Group {
        group: PerfGroup,
        counters: [Counter; 4],
    }

    pub(super) fn open() -> Result<Group, String> {
        let told = |error: std::io::Error| format!("no hardware counters here: {error}");
        let mut group = PerfGroup::new().map_err(told)?;
        let mut add = |event: Hardware| group.add(&Builder::new(event)).map_err(told);
        let counters = [
            add(Hardware::CPU_CYCLES)?,
            add(Hardware::INSTRUCTIONS)?,
            add(Hardware::BRANCH_MISSES)?,
            add(Hardware::CACHE_MISSES)?,
        ];
        Ok(Group { group, counters })
    }

    pub(super) fn around(group: &mut Group, rays: usize, work: impl FnOnce()) -> Option<CounterReading> {
        group.group.reset().ok()?;
        group.group.enable().ok()?;
        work();
        group.group.disable().ok()?;
        let counts = group.group.read().ok()?;
        let all_the_time = counts.time_enabled() == counts.time_running();
        let a_ray = |counter: &Counter| counts[counter] as f64 / rays as f64;
        let [cycles, instructions, branch_misses, cache_misses] = group.counters.each_ref().map(a_ray);
        all_the_time.then_some(CounterReading { cycles, instructions, branch_misses, cache_misses })
    }
}

#[cfg(not(target_os = "linux"))]
mod imp {
    use super::CounterReading;

    pub(super) struct Group;

    pub(super) fn open() -> Result<Group, String> {
        Err("no hardware counters here: known on Linux only".into())
    }

    pub(super) fn around(_: &mut Group, _: usize, work: impl FnOnce()) -> Option<CounterReading> {
        work();
        None
    }
}
