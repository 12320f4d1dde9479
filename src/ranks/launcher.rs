//! Whether a launcher of several ranks started the program, by what it leaves in the environment.

/// Variables in which a launcher gives each rank the number of ranks: Open MPI's mpirun; MPICH, Intel MPI and
/// their like; MVAPICH; Slurm's srun, which unlike SLURM_NTASKS is not set where nothing was started by it.
const SIZES: &[&str] = &["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MV2_COMM_WORLD_SIZE", "SLURM_STEP_NUM_TASKS"];
/// Variables in which other launchers give it its own number.
const NUMBERS: &[&str] = &["PMIX_RANK", "PMI_RANK"];

/// A launcher's trace in the environment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Launcher {
    pub(super) variable: &'static str,
    pub(super) value: String,
    /// If the launcher says how many.
    ranks: Option<usize>,
}

impl Launcher {
    /// The launcher that started this process, if any; srun with a single task counts as none.
    pub(super) fn find(variable: impl Fn(&str) -> Option<String>) -> Option<Launcher> {
        let number = |name: &str| variable(name)?.trim().parse::<usize>().ok();
        for &name in SIZES {
            let Some(ranks) = number(name) else { continue };
            if ranks > 1 || !name.starts_with("SLURM") {
                return Some(Launcher { variable: name, value: ranks.to_string(), ranks: Some(ranks) });
            }
        }
        let numbered = NUMBERS.iter().find_map(|&name| Some((name, number(name)?)));
        numbered.map(|(name, rank)| Launcher { variable: name, value: rank.to_string(), ranks: None })
    }

    /// Whether so many ranks are what it started. Where only the rank is known, all but rank 0 can tell a single one
    /// to be too few.
    pub(super) fn started(&self, found: usize) -> bool {
        self.ranks.map_or(found > 1 || self.value == "0", |ranks| ranks == found)
    }
}

/// The variable by which a launcher tells this process that it is one of several, and its value.
pub fn one_of_several() -> Option<(&'static str, String)> {
    let launcher = Launcher::find(|name| std::env::var(name).ok())?;
    (!launcher.started(1)).then_some((launcher.variable, launcher.value))
}

#[cfg(test)]
mod tests {
    use super::Launcher;

    fn found(variables: &[(&str, &str)]) -> Option<(&'static str, Option<usize>, bool)> {
        let variable = |name: &str| variables.iter().find(|(known, _)| *known == name).map(|(_, v)| (*v).to_owned());
        Launcher::find(variable).map(|launcher| (launcher.variable, launcher.ranks, launcher.started(1)))
    }

    /// A launcher is known by what it sets for each rank, and only by that.
    #[test]
    fn launchers_are_known_by_their_variables() {
        assert_eq!(found(&[]), None);
        let open_mpi = [("PMIX_RANK", "1"), ("OMPI_COMM_WORLD_SIZE", "4")];
        assert_eq!(found(&open_mpi), Some(("OMPI_COMM_WORLD_SIZE", Some(4), false)));
        assert_eq!(found(&[("PMI_RANK", "0"), ("PMI_SIZE", "1")]), Some(("PMI_SIZE", Some(1), true)));
        assert_eq!(found(&[("PMIX_RANK", "0")]), Some(("PMIX_RANK", None, true)));
        assert_eq!(found(&[("PMIX_RANK", "3")]), Some(("PMIX_RANK", None, false)));
        let srun = [("SLURM_PROCID", "1"), ("SLURM_NTASKS", "8"), ("SLURM_STEP_NUM_TASKS", "8")];
        assert_eq!(found(&srun), Some(("SLURM_STEP_NUM_TASKS", Some(8), false)));
    }

    /// Within a job of Slurm, but not started by srun or as its only task, a process is alone.
    #[test]
    fn a_job_script_is_one_process() {
        assert_eq!(found(&[("SLURM_PROCID", "0"), ("SLURM_NTASKS", "8")]), None);
        assert_eq!(found(&[("SLURM_PROCID", "0"), ("SLURM_NTASKS", "8"), ("SLURM_STEP_NUM_TASKS", "1")]), None);
    }
}
