(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* Claims as the checker of the page takes them, one JSON object a line (tests/browser/certificate_cases.cpp), judged by
   the proven checkers: prints 0 or 1 a line. Numbers it prints as it reads them. *)
open Checker
open Exact

let num = Decisions.number
let optional key v = match Json.find key v with Some (Json.Num x) -> Some x | _ -> None

let half_plane c =
  let s = match Json.get "shape" c with
    | Json.Obj ["disc", v] -> (0, Certificates.floats [] v)
    | Json.Obj ["ellipse", v] -> (3, Certificates.floats [] v)
    | Json.Obj [(("segment" | "polygon"), v)] -> (1, Certificates.floats [] v)
    | _ -> raise Json.Bad in
  let numbers = List.rev (snd s) in
  let q = fractions (numbers @ List.map (fun k -> num k c) ["x"; "y"; "radius"; "timeHorizon"; "ux"; "uy"; "nx"; "ny"; "c"]) in
  let f k = q (num k c) in
  Checked.half_plane_holds { body = Certificates.shape q (fst s, numbers); body_velocity = (f "ux", f "uy"); position = (f "x", f "y");
    radius = f "radius"; horizon = Some (f "timeHorizon"); normal = (f "nx", f "ny"); offset = f "c"; margin = q 0. }

let decision p a =
  let terms = List.map (fun t -> (Json.(str (get "kind" t)), Json.(count (get "index" t)), num "multiplier" t)) Json.(arr (get "terms" a)) in
  let multiplier i = List.fold_left (fun m (kind, k, x) -> if kind = "line" && k = i then m +. x else m) 0. terms in
  let line i l = ((num "x" l, num "y" l), num "c" l, Json.(bool (get "hard" l)), multiplier i) in
  let box = match optional "boxX" p, optional "boxY" p with Some x, Some y -> Some (x, y) | None, None -> None | _ -> raise Json.Bad in
  let part (kind, _, m) = match kind with "line" -> None | "disc" -> Some (kind, m) | _ -> Some ("box-" ^ kind, m) in
  Decisions.is_best { lines = List.mapi line Json.(arr (get "lines" p)); disc = optional "disc" p; box;
    preferred = (num "px" p, num "py" p); velocity = (num "vx" a, num "vy" a); status = Json.(str (get "status" a));
    parts = List.filter_map part terms }

let () =
  let judge = function
    | Json.Num x -> Printf.sprintf "%h" x
    | v -> if match Json.find "claim" v with Some c -> half_plane c | None -> decision (Json.get "problem" v) (Json.get "answer" v) then "1" else "0" in
  let rec go () = match input_line stdin with
    | l -> print_endline (judge (Json.parse l)); go ()
    | exception End_of_file -> () in
  go ()
