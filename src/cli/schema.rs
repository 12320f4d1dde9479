//! `corpuscle schema`: the JSON schema of scene files, for editors.

use super::CliError;
use super::terminal::say;

pub fn schema() -> Result<(), CliError> {
    say(&(serde_json::to_string_pretty(&crate::scene::schema())? + "\n"))
}
