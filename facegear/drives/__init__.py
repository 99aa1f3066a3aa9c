"""A drive of one's own: its file, the report on it, the explorer, files for other programs, the command `facegear`.

The file: `drive_file` reads; `drive_keys` has all keys, of which `keys` says what each is, `file_values` checks them
one by one, `file_teeth` and `file_gearbox` build what they say of `contacts`, `flexible_teeth`, `forces`, `tolerances`,
`refusals` tells in the file's words what models refuse. `drive_text` writes, `drive_schema` tells editors and readers
the keys, `new_drive` asks for what a file needs; `examples` come with the package.

What holds: `basis`, `shaft_modes`, `verdict`, `critical_thickness`, `report_rows`, `report_arrays`, `disk_response`,
`play` of the teeth, `damage` of one; `findings` has all that a report shows, `sections` and `page` put it in words,
`report_columns` and `report_files` write; `sweeps` are maps over any number of a file, `map_files` write them.

A verdict for all that is open: `assess` asks all `variants` of a model, each an `outcome`, and for the `worst_case` in
its tolerances, which `tolerance_cells` find, for an `assessment` over `intervals` of speed, in `growth_words`,
`disk_response_words` and what `torsion_response` says, with arrays of `assessment_table`, `disk_response_table` and
`response_peaks`, which `assessment_files` write, and `assessment_columns` as tables.

The explorer: `studies`, `file_study`, `explore`, in `stages`, and `cell` compute what it shows, `explorer` and
`motion_explorer` draw it with a `map_figure`, a `cell_figure` and `widgets`, `live` serves it.

`export` writes points, meshes, tables. The command: `command`, after `command_line` has understood what is asked for,
runs one of `commands`.
Public: `read_drive_file`, `write_drive_file`.
"""
