//! What a bench ran on beside the device, when, and what it took of the host's processor.

use std::time::SystemTime;

use serde_json::{Value, json};

/// The environment variable by which lavapipe is told how many threads to hand its work to.
pub const THREADS: &str = "LP_NUM_THREADS";

/// Of a software device: as many as it is told to take, or all cores.
pub fn threads() -> f64 {
    told_threads(std::env::var(THREADS).ok().as_deref())
        .or_else(|| std::thread::available_parallelism().ok().map(usize::from))
        .unwrap_or(1) as f64
}

/// Told to hand its work to none it does it in the thread that takes the commands.
fn told_threads(told: Option<&str>) -> Option<usize> {
    told?.parse().ok().map(|threads: usize| threads.max(1))
}

/// This moment, this host and this build, as JSON.
pub fn record() -> Value {
    json!({
        "date": humantime::format_rfc3339_seconds(SystemTime::now()).to_string(),
        "cpu": cpu_name(std::fs::read_to_string("/proc/cpuinfo").ok().as_deref()),
        "cpu_threads": std::thread::available_parallelism().ok().map(usize::from),
        THREADS.to_lowercase(): std::env::var(THREADS).ok(),
        "version": env!("CARGO_PKG_VERSION"),
        // Of the working tree that it was built in, if there was one; `sources` is a number of what it was built from.
        "commit": option_env!("CORPUSCLE_COMMIT"),
        "sources": env!("CORPUSCLE_SOURCE"),
        "build": if cfg!(debug_assertions) { "debug" } else { "release" },
        "mpi": cfg!(feature = "mpi"),
    })
}

/// The processor's name for itself, where Linux tells it.
fn cpu_name(cpuinfo: Option<&str>) -> Option<String> {
    let line = cpuinfo?.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned()).filter(|name| !name.is_empty())
}

/// Processor time since some moment, s; `None` where the system has no such clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CpuTime {
    /// Of this thread, which encodes the steps, submits them and waits for them.
    pub thread: Option<f64>,
    /// Of all threads of this process: also those of a driver, and of a device that is software.
    pub process: Option<f64>,
}

impl CpuTime {
    #[cfg(unix)]
    pub fn now() -> CpuTime {
        use rustix::time::{ClockId, clock_gettime};
        let read = |clock| {
            let time = clock_gettime(clock);
            Some(time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64)
        };
        CpuTime { thread: read(ClockId::ThreadCPUTime), process: read(ClockId::ProcessCPUTime) }
    }

    #[cfg(not(unix))]
    pub fn now() -> CpuTime {
        CpuTime { thread: None, process: None }
    }

    #[must_use]
    pub fn since(self, start: CpuTime) -> CpuTime {
        let less = |now: Option<f64>, then: Option<f64>| Some(now? - then?);
        CpuTime { thread: less(self.thread, start.thread), process: less(self.process, start.process) }
    }
}

/// Shares of a core that the host had to do with in `seconds`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HostLoad {
    pub thread: Option<f64>,
    /// All of it; `None` also where the device is the processor, whose work is in the same threads' time.
    pub process: Option<f64>,
}

impl HostLoad {
    pub fn new(cpu: CpuTime, seconds: f64, device_is_cpu: bool) -> HostLoad {
        let share = |time: Option<f64>| time.filter(|_| seconds > 0.0).map(|time| time / seconds);
        HostLoad { thread: share(cpu.thread), process: share(cpu.process).filter(|_| !device_is_cpu) }
    }

    /// What of a core the host takes while the device works, in words.
    pub fn told(&self, device_is_cpu: bool) -> String {
        let percent = |share: f64| format!("{:.1} % of a core", 100.0 * share);
        let thread = self.thread.map_or_else(|| "not measurable here".into(), percent);
        let process = match (self.process, device_is_cpu) {
            (Some(share), _) => percent(share),
            (None, true) => "not measurable: the device is the CPU".into(),
            (None, false) => "not measurable here".into(),
        };
        format!("host: {process}; the thread that submits the steps alone: {thread}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_processor_is_named_as_linux_names_it() {
        let text = "processor\t: 0\nmodel\t\t: 17\nmodel name\t: A Processor 9000\nmodel name\t: another\n";
        assert_eq!(cpu_name(Some(text)).as_deref(), Some("A Processor 9000"));
        assert_eq!(cpu_name(Some("processor\t: 0\n")), None);
        assert_eq!(cpu_name(None), None);
    }

    #[test]
    fn a_device_that_hands_its_work_to_nobody_is_one_thread() {
        let told = [None, Some("many"), Some("0"), Some("1"), Some("8")].map(told_threads);
        assert_eq!(told, [None, None, Some(1), Some(1), Some(8)]);
    }

    #[test]
    fn the_record_says_when_and_of_what_build() {
        let record = record();
        let date = record["date"].as_str().unwrap();
        assert!(humantime::parse_rfc3339(date).is_ok() && date.len() == 20, "{date}");
        assert_eq!(record["version"], env!("CARGO_PKG_VERSION"));
        assert!(record["build"] == "debug" || record["build"] == "release");
        assert_eq!(record["sources"].as_str().unwrap().len(), 16);
    }

    /// A device that is the processor works in the threads that would be measured.
    #[test]
    fn no_figure_is_told_of_a_host_that_is_the_device() {
        let cpu = CpuTime { thread: Some(0.02), process: Some(1.5) };
        let gpu = HostLoad::new(cpu, 2.0, false);
        assert_eq!(gpu, HostLoad { thread: Some(0.01), process: Some(0.75) });
        assert!(gpu.told(false).starts_with("host: 75.0 % of a core; "));
        let software = HostLoad::new(cpu, 2.0, true);
        assert_eq!(software.process, None);
        assert!(software.told(true).contains("not measurable: the device is the CPU"));
        assert_eq!(HostLoad::new(cpu, 0.0, false), HostLoad { thread: None, process: None });
    }

    #[cfg(unix)]
    #[test]
    fn a_thread_that_works_takes_time_of_its_process() {
        let start = CpuTime::now();
        let mut x = 1.0_f64;
        while CpuTime::now().since(start).thread.unwrap() <= 0.0 {
            x = std::hint::black_box(x).sqrt();
        }
        let taken = CpuTime::now().since(start);
        assert!(taken.thread.unwrap() > 0.0 && taken.process.unwrap() > 0.0, "{taken:?}");
    }
}
