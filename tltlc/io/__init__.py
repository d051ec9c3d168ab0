"""All access to the operating system: files, their limits, the project file, and limits of time and memory."""
