//! What a run leaves in its folder, and what it never touches: locks, resumes, signals, logs.
