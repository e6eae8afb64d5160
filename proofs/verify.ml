(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* exactvo-verify: the command line. *)
open Recordings

let usage = "Check certificates and recordings by checkers that are proven in Coq\n\
Usage: exactvo-verify [OPTIONS] FILE...\n\n\
Positionals:\n\
\032 FILE                Certificates, as audit --certificate takes them; a recording.jsonl; a crowd's FILE.evr; answers of lp --json with --problems; a folder searched for recordings of both kinds; - for stdin\n\n\
Options:\n\
\032 -h,--help           Print this help message and exit\n\
\032 -V,--version        Print the version, and what it was proven and built with\n\
\032 --problems FILE     The problems, a line of JSON each, that the one FILE has the answers of\n\n\
Examples:\n\
\032 exactvo route office.geojson --from 2,3 --to 18,7 --radius 0.4 --json | exactvo-verify -\n\
\032 exactvo lp problems.jsonl --json > answers.jsonl && exactvo-verify answers.jsonl --problems problems.jsonl\n\
\032 exactvo check tracks.csv --radius 0.3 --certificates proofs.jsonl && exactvo-verify proofs.jsonl\n\
\032 exactvo-verify out\n\
\032   (what is proven, and what is trusted: docs/guide/proofs.md)\n\n\
Exit status:\n\
\032 0    all of it is verified\n\
\032 1    some of it is not, or is of a kind that is not covered\n\
\032 2    a file or an option is wrong; the other files are judged all the same\n"

exception Wrong_option of string

type asked = Help | Version | Judge of { files : string list; problems : string option }

let rec parse asked_files problems = function
  | ("-h" | "--help") :: _ -> Help
  | ("-V" | "--version") :: _ -> Version
  | ["--problems"] -> raise (Wrong_option "--problems: found nothing behind it, expected a file")
  | "--problems" :: f :: rest -> if problems = None then parse asked_files (Some f) rest else raise (Wrong_option "--problems: found twice, expected once")
  | "--" :: rest -> finish (List.rev_append asked_files rest) problems
  | ("" as f) :: _ -> raise (Wrong_option ("found '" ^ f ^ "', expected a file or a folder"))
  | f :: rest when f = "-" || f.[0] <> '-' -> parse (f :: asked_files) problems rest
  | option :: _ -> raise (Wrong_option ("found '" ^ option ^ "', expected FILE..., --problems FILE, --version or --help"))
  | [] -> finish (List.rev asked_files) problems
and finish files problems = match files, problems with
  | [], _ -> raise (Wrong_option "found no file, expected FILE... (--help)")
  | _ :: _ :: _, Some _ -> raise (Wrong_option (Printf.sprintf "--problems: found %d files of answers, expected one" (List.length files)))
  | _ -> Judge { files; problems }

(* Every recording.jsonl and recording of a crowd below the folder, in the order of their names. *)
let rec recordings_below folder =
  let names = Sys.readdir folder in
  Array.sort String.compare names;
  let first_bytes path =
    let c = open_in_bin path in
    Fun.protect ~finally:(fun () -> close_in c) (fun () -> really_input_string c (min 9 (in_channel_length c))) in
  let is_one name path = name = "recording.jsonl" || is_crowd (first_bytes path) in
  List.concat_map (fun name ->
    let path = Filename.concat folder name in
    match (Unix.lstat path).st_kind with
    | Unix.S_DIR -> recordings_below path
    | Unix.S_REG when is_one name path -> [path]
    | _ -> []) (Array.to_list names)

let files_of path =
  if path <> "-" && Sys.file_exists path && Sys.is_directory path then
    match recordings_below path with
    | [] -> refuse path "" "a folder without recordings" "a folder with a recording.jsonl or a crowd's FILE.evr" "E_FORMAT_UNKNOWN"
    | found -> found
  else [path]

(* 0, 1 or 2; what is wrong is printed. *)
let status_of work =
  let wrong words = flush stdout; prerr_endline ("exactvo-verify: error: " ^ String.trim words); 2 in
  match work () with
  | true -> 0
  | false -> 1
  | exception Stack_overflow -> wrong "found more robots or numbers than the stack holds, expected a larger one (ulimit -s unlimited)"
  | exception Wrong_option words -> wrong words
  | exception Sys_error words -> wrong (words ^ " [E_FILE_UNREADABLE]")
  | exception Refused (f, place, found, expected, code) ->
    wrong (Printf.sprintf "%s: %sfound %s, expected %s [%s]" f (if place = "" then "" else place ^ ": ") found expected code)

let judge_all files problems =
  let worst = ref 0 in
  let take work = let s = status_of work in worst := max !worst s; s in
  let all = List.concat_map (fun f -> let found = ref [] in ignore (take (fun () -> found := files_of f; true)); !found) files in
  match all, problems with
  | [file], Some problems -> ignore (take (fun () -> answers file (read file) problems)); !worst
  | [file], None -> ignore (take (fun () -> judge file)); !worst
  | [], _ -> !worst
  | _ ->
    let one file = Printf.printf "%s\n" file; let s = take (fun () -> judge file) in print_newline (); s in
    let verdicts = List.map one all in
    let count s = List.length (List.filter (( = ) s) verdicts) in
    Printf.printf "%d files: %d verified, %d not, %d wrong\n" (List.length all) (count 0) (count 1) (count 2);
    !worst

let () =
  exit (match parse [] None (List.tl (Array.to_list Sys.argv)) with
    | Help -> print_string usage; 0
    | Version -> print_string Version.text; 0
    | Judge { files; problems } -> judge_all files problems
    | exception Wrong_option words -> status_of (fun () -> raise (Wrong_option words)))
