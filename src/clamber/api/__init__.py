"""The public functions of Clamber: `import clamber` offers them by name and loads each when it is first asked for."""
