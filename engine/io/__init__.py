"""Pictures and scenes as files."""
