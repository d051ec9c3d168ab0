"""What has changed from one version of specs to another: the traces they accept, and what else a host would notice."""
