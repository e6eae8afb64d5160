(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* The reader, continued: files of certificates, answers of `exactvo lp`, recordings and recordings of crowds. *)
open Checker
open Exact

(* file, place, what was found, what was expected, code (docs/guide/codes.md) *)
exception Refused of string * string * string * string * string
let refuse file place found expected code = raise (Refused (file, place, found, expected, code))

let read file =
  let all channel =
    let size = try in_channel_length channel with Sys_error _ -> 0 in  (* a pipe has none *)
    let b = Buffer.create (size + 65536) and part = Bytes.create 65536 in
    let rec go () = let n = input channel part 0 65536 in if n > 0 then (Buffer.add_subbytes b part 0 n; go ()) in
    go ();
    Buffer.contents b in
  match if file = "-" then all stdin else let c = open_in_bin file in Fun.protect ~finally:(fun () -> close_in c) (fun () -> all c) with
  | text -> text
  | exception Sys_error _ ->
    if Sys.file_exists file then refuse file "" "a file that cannot be read" "a certificate or a recording" "E_FILE_UNREADABLE"
    else refuse file "" "no such file" "a file that can be read" "E_FILE_MISSING"

(* The end of the line that k is in. Of eight bytes at once it asks whether one is a line feed. *)
let rec line_end text k =
  let n = String.length text in
  let none = k + 8 <= n && (let w = Int64.logxor (String.get_int64_ne text k) 0x0A0A0A0A0A0A0A0AL in
    Int64.logand (Int64.logand (Int64.sub w 0x0101010101010101L) (Int64.lognot w)) 0x8080808080808080L = 0L) in
  if none then line_end text (k + 8) else if k = n || text.[k] = '\n' then k else line_end text (k + 1)
(* Where the lines that are not blank begin and end. *)
let spans text =
  let n = String.length text in
  let blank c = c = ' ' || c = '\t' || c = '\r' in
  let rec is_blank k stop = k = stop || (blank text.[k] && is_blank (k + 1) stop) in
  let rec from start found =
    let stop = line_end text start in
    let found = if is_blank start stop then found else (start, stop) :: found in
    if stop = n then List.rev found else from (stop + 1) found in
  from 0 []
let lines text = List.map (fun (start, stop) -> String.sub text start (stop - start)) (spans text)
let counted n one = Printf.sprintf "%d %s%s" n one (if n = 1 then "" else "s")

(* --- Certificates: every `certificate` of JSON, or one a line --- *)
let rec in_json found none v =
  match v with
  | Json.Str s -> if Certificates.begins s then found (Certificates.line s)
  | Json.Arr l -> List.iter (in_json found none) l
  | Json.Obj _ when Certificates.is_certificate v -> Option.iter found (Certificates.of_kind v)
  | Json.Obj m -> List.iter (fun (k, c) ->
      if k <> "certificate" then in_json found none c else match c with
        | Json.Null -> none ()
        | Json.Str s -> found (Certificates.line s)
        | c -> found (match Json.find "text" c with
            | Some (Json.Str s) when not (Certificates.is_certificate c) -> Certificates.line s
            | _ -> Option.value (Certificates.of_kind c) ~default:"not a certificate")) m
  | _ -> ()

let certificates file text =
  Certificates.obstacles := None;
  let verdicts = ref [] and none = ref 0 in
  let found v = verdicts := v :: !verdicts in
  let json span = match Json.parse_part text span with v -> in_json found (fun () -> incr none) v | exception Json.Bad -> found "unreadable JSON" in
  let is_json = let rec first k = k < String.length text && (match text.[k] with ' ' | '\t' | '\r' | '\n' -> first (k + 1) | c -> c = '{' || c = '[') in first 0 in
  let ls = spans text in
  if is_json then (match Json.parse text with
    | v -> in_json found (fun () -> incr none) v
    | exception Json.Bad -> if List.length ls > 1 then List.iter json ls else found "unreadable JSON")
  else begin
    let ls = lines text in
    if List.exists Certificates.begins ls then List.iter (fun l -> found (Certificates.line l)) ls
  end;
  if !verdicts = [] && !none = 0 then refuse file "" "no certificate" "a certificate a line" "E_FORMAT_UNKNOWN";
  let all = List.rev !verdicts in
  List.iteri (fun i v -> Printf.printf "%d: %s\n" (i + 1) v) all;
  let valid = List.length (List.filter (( = ) "valid") all) in
  Printf.printf "%s, %d valid%s\n" (counted (List.length all) "certificate") valid (if !none > 0 then Printf.sprintf ", %d none" !none else "");
  valid = List.length all

(* Whether the velocity of a choice breaks no half-plane, nor the speed bound, by more than 2^-40 of the largest terms. *)
let nearly program c =
  let size r = Q.add (Q.abs (to_q (fst r.row_normal))) (Q.abs (to_q (snd r.row_normal))) in
  let speed = Q.add (Q.abs (to_q (fst c.velocity))) (Q.abs (to_q (snd c.velocity))) in
  let unit = List.fold_left (fun m r -> Q.max m (Q.add (Q.mul (size r) speed) (Q.abs (to_q r.row_offset)))) Q.zero program.rows in
  let give = Q.div_2exp unit 40 in
  let lowered r = { r with row_offset = of_q (Q.sub (to_q r.row_offset) give) } in
  let raised = Option.map (fun b -> let x = to_q b in of_q (Q.add x (Q.div_2exp x 40))) in
  Checked.pinned { rows = List.map lowered program.rows; disc = raised program.disc; box_x = raised program.box_x; box_y = raised program.box_y;
    wish = program.wish } c.velocity

(* --- Answers of `exactvo lp`, beside the problems that they answer --- *)
(* What it does not know would change the problem, and what it read in its place would be proven of another one. *)
let known keys = function Json.Obj members when List.for_all (fun (k, _) -> List.mem k keys) members -> () | _ -> raise Json.Bad
let word key words v = match Json.find key v with
  | None -> List.hd words
  | Some (Json.Str w) when List.mem w words -> w
  | _ -> raise Json.Bad
let pair_of v = match Json.arr v with [x; y] -> (Json.num x, Json.num y) | _ -> raise Json.Bad
let answer p a =
  let q = over (max (Certificates.bits_needed p) (Certificates.bits_needed a)) in
  let at v = let x, y = pair_of v in (q x, q y) in
  let at_least_0 v = let x = Json.num v in if x < 0. then raise Json.Bad else q x in
  let bound = Option.value (Json.find "bound" p) ~default:(Json.Obj []) in
  let bound_on = function Json.Null -> None | x -> Some (at_least_0 x) in
  let box = match Json.find "box" bound with None -> [None; None] | Some (Json.Arr [x; y]) -> [bound_on x; bound_on y] | _ -> raise Json.Bad in
  let soft c = word "priority" ["hard"; "soft"] c = "soft" in
  let status = Json.(str (get "status" a)) in
  let infeasible = status = "infeasible" in
  (* Where even the hard ones contradict each other, they give, and the soft ones do not count. *)
  let constraints = Json.(arr (get "constraints" p)) in
  known ["preferred"; "constraints"; "bound"; "objective"] p;
  known ["disc"; "box"] bound;
  List.iter (known ["normal"; "offset"; "priority"; "label"]) constraints;
  let kept = List.mapi (fun i c -> (i, c)) constraints |> List.filter (fun (_, c) -> not (infeasible && soft c)) in
  let side x y b = match b with None -> [] | Some b -> [{ row_normal = (q x, q y); row_offset = { b with qnum = Whole.neg b.qnum }; soft = false }] in
  let sides = List.map2 (fun name s -> (name, s)) ["box-right"; "box-left"; "box-top"; "box-bottom"]
      [side (-1.) 0. (List.nth box 0); side 1. 0. (List.nth box 0); side 0. (-1.) (List.nth box 1); side 0. 1. (List.nth box 1)] in
  let rows = List.map (fun (_, c) -> { row_normal = at (Json.get "normal" c); row_offset = q Json.(num (get "offset" c)); soft = infeasible || soft c }) kept in
  let certificate = Json.get "certificate" a in
  let terms key = List.map (fun t -> (Json.get "constraint" t, List.map Json.num Json.(arr (get "multiplier" t)))) Json.(arr (get key certificate)) in
  let sum name ts = of_q (List.fold_left (fun s (n, ms) ->
      if n = name then Q.add s (List.fold_left Q.add Q.zero (List.map (fun m -> to_q (q m)) ms)) else s) Q.zero ts) in
  let known = Json.Str "disc" :: List.map (fun (i, _) -> Json.Num (float_of_int i)) kept
    @ List.filter_map (fun (n, s) -> if s = [] then None else Some (Json.Str n)) sides in
  let multipliers key =
    let ts = terms key in
    let negative (_, ms) = Q.sign (List.fold_left (fun s m -> Q.add s (to_q (q m))) Q.zero ms) < 0 in
    if List.exists (fun t -> not (List.mem (fst t) known) || negative t) ts || List.length ts > 3 then raise Json.Bad;
    (List.map (fun (i, _) -> sum (Json.Num (float_of_int i)) ts) kept
     @ List.concat_map (fun (n, s) -> if s = [] then [] else [sum (Json.Str n) ts]) sides, sum (Json.Str "disc") ts) in
  let pull, mu = if status = "no-interior" then ([], of_q Q.zero) else multipliers "bound" in
  let against, _ = multipliers "contradiction" in
  if Json.(num (get "violation" a)) < 0. || Json.(num (get "gap" certificate)) < 0. then raise Json.Bad;
  let program = { rows = rows @ List.concat_map snd sides; disc = Option.map at_least_0 (Json.find "disc" bound);
    box_x = List.nth box 0; box_y = List.nth box 1; wish = at (Json.get "preferred" p) } in
  let choice = { velocity = at (Json.get "velocity" a); gap = q Json.(num (get "gap" certificate));
    violation = q Json.(num (get "violation" a)); pull; mu; against } in
  match status with
  | "optimal" -> if word "objective" ["nearest"; "farthest"] p = "farthest" then Checked.farthest program choice else Checked.nearest program choice
  | "relaxed" | "infeasible" -> Checked.least program choice
  | "no-interior" ->
    (* The point nearest 0 on the boundaries named: whatever point this is, the checker asks whether it satisfies all. *)
    let contradicts = terms "contradiction" <> [] in
    let boundary n = match n with
      | Json.Num _ -> List.nth (List.filter_map (fun (i, c) -> if Json.Num (float_of_int i) = n then Some c else None) kept) 0
        |> fun c -> let x, y = pair_of (Json.get "normal" c) in (Q.of_float x, Q.of_float y, Q.of_float Json.(num (get "offset" c)))
      | n -> (match List.assoc_opt (Json.str n) sides with
          | Some [r] -> (to_q (fst r.row_normal), to_q (snd r.row_normal), to_q r.row_offset) | _ -> raise Json.Bad) in
    let x, y = match List.map boundary Json.(arr (get "vertex" certificate)) with
      | [] -> (Q.zero, Q.zero)
      | [(a, b, c)] -> let n = Q.add (Q.mul a a) (Q.mul b b) in (Q.div (Q.mul a c) n, Q.div (Q.mul b c) n)
      | [(a, b, c); (d, e, f)] ->
        let w = Q.sub (Q.mul a e) (Q.mul b d) in
        if Q.sign w = 0 then raise Json.Bad;
        (Q.div (Q.sub (Q.mul c e) (Q.mul b f)) w, Q.div (Q.sub (Q.mul a f) (Q.mul c d)) w)
      | _ -> raise Json.Bad in
    let must_hold = if contradicts then { program with rows = List.filter (fun r -> not r.soft) program.rows } else program in
    (not contradicts || Checked.contradicted program choice)
    && Checked.pinned must_hold (of_q x, of_q y) && nearly must_hold choice
  | _ -> raise Json.Bad

let answers file text problems =
  let parsed f t = try Json.parse t with Json.Bad -> refuse f "" "no JSON" "a JSON object a line" "E_FORMAT_SYNTAX" in
  let problems = Array.of_list (List.map (parsed problems) (lines (read problems))) in
  let all = List.filter (fun a -> Json.find "status" a <> None) (List.map (parsed file) (lines text)) in
  let verdict a = try
      let i = Json.(count (get "index" a)) in
      if i >= Array.length problems then "of no problem" else if Json.get "certificate" a = Json.Null then "no certificate"
      else if answer problems.(i) a then "valid" else "not proven"
    with Json.Bad | Malformed | Failure _ -> "malformed" in
  let verdicts = List.map verdict all in
  List.iteri (fun i v -> Printf.printf "%d: %s\n" (i + 1) v) verdicts;
  let valid = List.length (List.filter (( = ) "valid") verdicts) in
  let gap a = match Json.find "certificate" a with Some c -> (match Json.find "gap" c with Some (Json.Num g) -> g | _ -> 0.) | None -> 0. in
  let largest = List.fold_left2 (fun m a v -> if v = "valid" then Float.max m (gap a) else m) 0. all verdicts in
  Printf.printf "%s, %d valid, up to a gap of %.2g\n" (counted (List.length all) "certificate") valid largest;
  if all = [] then refuse file "" "no answer" "what exactvo lp --json prints" "E_FORMAT_UNKNOWN";
  valid = List.length all

(* --- Recordings --- *)
type tally = { mutable asked : int; mutable robots_apart : int; mutable edges_clear : int; mutable first : string option }

(* Whether the motions are proven clear of each other and of all obstacles. Robots that are outside of all polygons at
   their beginning stay so by `step_sound`; where it is not known that they are (~anew), that is asked too. *)
let take tally place ~anew os discs ms =
  tally.asked <- tally.asked + 1;
  let all = Checked.step os discs ms && (not anew || Checked.starts os ms) in
  let robots = all || Checked.step [] [] ms in
  if robots then tally.robots_apart <- tally.robots_apart + 1;
  if all then tally.edges_clear <- tally.edges_clear + 1
  else if tally.first = None then
    tally.first <- Some (place ^ if robots then ": a robot is not proven clear of an obstacle" else ": two robots are not proven apart");
  all

let report t what rows robots obstacles not_covered incomplete =
  Printf.printf "%s of %s, %s: %d asked, in %d no two robots overlap, in %d also no robot overlaps %s\n"
    (counted rows "row") (counted robots "robot") what t.asked t.robots_apart t.edges_clear obstacles;
  Option.iter (fun f -> Printf.printf "  %s\n" f) t.first;
  print_string "not verified:\n  that the file says what happened; docs/guide/proofs.md has what else is trusted\n";
  List.iter (fun s -> Printf.printf "  %s\n" s) not_covered;
  t.edges_clear = t.asked && not incomplete

let within_tracking = "that bodies are within the tracking error of where rows have them: that is assumed"
let of_wheels = "of robots on wheels more than discs about their reference points; audit checks that bodies and wheels follow"

let recording file text =
  let scenario = ref Json.Null and obstacles = ref [] and discs = ref [] and sizes = ref [] and bits = ref 0 in
  let last = ref None and rows = ref 0 and ended = ref false and robots = ref 0 and not_covered = ref [] and curved = ref false in
  let t = { asked = 0; robots_apart = 0; edges_clear = 0; first = None } and decisions = Decisions.start () in
  let brakes = ref None and outside = ref false in
  let prepare b =
    bits := b;
    let q = over b in
    let round, others = Wheels.obstacles !scenario in
    obstacles := List.map (Certificates.obstacle q) others;
    discs := List.map (fun o -> Certificates.disc q (Json.get "disc" o)) round;
    sizes := List.map (fun r -> q Json.(num (get "radius" r))) Json.(arr (get "robots" !scenario)) in
  let header h =
    if Json.find "kind" h <> Some (Json.Str "exactvo-recording") then raise Json.Bad;
    curved := Json.find "motion" h <> Some (Json.Str "straight");
    if !curved then not_covered := ["the motions: robots do not move straight from row to row, and only the rows were looked at"];
    let on_wheels = List.exists (fun r -> Wheels.drive r <> None) Json.(arr (get "robots" (get "scenario" h))) in
    scenario := Wheels.as_discs (Json.get "scenario" h);
    robots := List.length Json.(arr (get "robots" !scenario));
    if Wheels.tracking (Json.get "scenario" h) > 0. then not_covered := !not_covered @ [within_tracking];
    if List.exists Wheels.has_footprint Json.(arr (get "robots" !scenario)) then not_covered := !not_covered @ ["that robots keep clear of obstacles: some have footprints, which turn; audit checks this"];
    if on_wheels then not_covered := !not_covered @ [of_wheels];
    let measures = match Json.find "uncertainty" !scenario with
      | Some (Json.Obj _ as bounds) -> not (List.mem (Json.find "measurements" bounds) [None; Some Json.Null])
      | _ -> false in
    if measures then not_covered := !not_covered @ ["that robots measured each other within the bounds, and may each brake alone: they are proven to brake all at once; audit checks this"];
    if Json.find "moving_obstacles" !scenario <> Some (Json.Arr []) then not_covered := !not_covered @ ["that robots are clear of moving obstacles"];
    not_covered := !not_covered @ ["plans, half-planes that are not counted above, and that none is missing";
      "choices without room, with exact multipliers or with half-planes of a user"; "that rows follow from choices and from one another in time, and that the scenario is the one that was meant"];
    brakes := Braking.start !scenario;
    prepare (Certificates.bits_needed !scenario) in
  let row r =
    let ps = List.map (fun x -> pair_of (Json.get "position" x)) Json.(arr (get "robots" r)) in
    let need = List.fold_left (fun m (x, y) -> max m (max (bits_of x) (bits_of y))) !bits ps in
    if need > !bits then prepare need;
    let here = let q = over !bits in List.map (fun (x, y) -> (q x, q y)) ps in
    if List.length ps <> !robots then raise Json.Bad;
    (* The row before may have been read with another denominator: the checkers take any. *)
    let before, anew = match !last with Some b when not !curved -> (b, not !outside) | _ -> (here, true) in
    let moves = List.rev (List.rev_map2 (fun size (from, to0) -> { from; to0; size }) !sizes (List.combine before here)) in
    outside := take t (Printf.sprintf "row %d" !rows) ~anew !obstacles !discs moves;
    Decisions.row decisions !scenario Json.(arr (get "robots" r));
    Option.iter (fun b -> Braking.row b ~outside:!outside Json.(arr (get "robots" r))) !brakes;
    last := Some here; incr rows in
  List.iteri (fun i l ->
    let bad () = refuse file (Printf.sprintf "line %d" (i + 1)) "a line that is not of a recording" "a recording.jsonl, as simulate --out writes it" "E_FORMAT_SYNTAX" in
    match Json.parse l with
    | Json.Obj [("header", h)] -> (try header h with Json.Bad -> bad ())
    | Json.Obj [("row", r)] -> (try row r with Json.Bad | Malformed -> bad ())
    | Json.Obj [("end", e)] -> ended := true; if Json.find "rows" e <> Some (Json.Num (float_of_int !rows)) then bad ()
    | Json.Obj [("body", b)] -> (try Decisions.body decisions b with Json.Bad -> bad ())
    | Json.Obj [("goal_bodies", g)] -> (try Decisions.goal_bodies decisions g with Json.Bad -> bad ())
    | Json.Obj [("plan", _)] -> ()
    | _ | exception Json.Bad -> bad ()) (lines text);
  (try Decisions.check_bodies decisions !scenario
   with Json.Bad | Malformed -> refuse file "" "bodies that are not of a recording" "a recording.jsonl, as simulate --out writes it" "E_FORMAT_SYNTAX");
  let decided = Decisions.report decisions in
  let stop = Option.fold ~none:true ~some:Braking.report !brakes in
  let ok = report t "the first row and each motion to the next" !rows !robots
      (Printf.sprintf "one of %s with %s%s" (counted (List.length !obstacles) "obstacle") (counted (List.length (List.concat_map edges_of !obstacles)) "edge")
        (if !discs = [] then "" else " and of " ^ counted (List.length !discs) "disc")) !not_covered !curved in
  if not !ended then refuse file (Printf.sprintf "row %d" !rows) "the end of the file" "a last line \"end\": the recording ends early" "E_CUT_OFF";
  ok && decided && stop

(* --- Recordings of crowds: docs/guide/crowd-recordings.md --- *)
let crowd file s =
  let bad at found = refuse file (Printf.sprintf "byte %d" at) found "what simulate --record has written" "E_FORMAT_SYNTAX" in
  let version = Char.code s.[7] - Char.code '0' in
  let pos = ref 8 and stop = ref (String.length s) in
  let need n = if !pos + n > !stop then bad !pos "its end too early"; pos := !pos + n; !pos - n in
  let u8 () = Char.code s.[need 1] in
  let u16 () = String.get_uint16_le s (need 2) in
  let u32 () = Int32.to_int (String.get_int32_le s (need 4)) land 0xFFFFFFFF in
  let u64 () = String.get_int64_le s (need 8) in
  let f64 () = let x = Int64.float_of_bits (u64 ()) in if Float.is_finite x then x else bad !pos "a number that is not finite" in
  let difference () =
    let rec go v shift = let b = u8 () in let v = v lor ((b land 0x7F) lsl shift) in if b >= 0x80 then go v (shift + 7) else v in
    let v = go 0 0 in (v lsr 1) lxor (- (v land 1)) in
  let block f = if !pos + 16 > String.length s then None else
    let size = Int64.to_int (u64 ()) in
    let stated = u64 () in
    let a = !pos in
    if size < 0 || a + size > String.length s then None else begin
      let h = ref 0xCBF29CE484222325L in
      for i = a to a + size - 1 do h := Int64.mul (Int64.logxor !h (Int64.of_int (Char.code (String.unsafe_get s i)))) 0x100000001B3L done;
      if !h <> stated then bad a "another checksum than its content has";
      stop := a + size;
      let v = f () in
      pos := a + size; stop := String.length s; Some v
    end in
  let list n f = List.init n (fun _ -> f ()) in
  let head () =
    ignore (need (u32 ()));
    let time_step = f64 () in
    let q = f64 () in let every = u32 () in
    let kinds = Array.of_list (list (u32 ()) (fun () -> let r = f64 () in (r, f64 ()))) in
    let kind_of = list (u32 ()) (fun () -> let k = u16 () in if k >= Array.length kinds then bad !pos "a robot of an unknown kind" else k) in
    let edges = list (u32 ()) (fun () -> let x = f64 () in let y = f64 () in let u = f64 () in (x, y, u, f64 ())) in
    let bodies = if version >= 2 then u32 () else 0 in
    if version >= 5 then for _ = 1 to bodies do ignore (need 2); ignore (need (8 * u32 ())) done;
    let length () = let x = f64 () in if x < 0. then bad !pos "a length below 0" else x in
    let tracking = if version >= 5 then length () else 0. in
    let on_wheels = ref false in
    (* Whether the disc of a kind holds its body. *)
    let holds (radius, speed) =
      let body = length () in
      let left = Q.sub (Q.of_float radius) (Q.of_float tracking) in
      if u8 () = 0 then Q.leq (Q.of_float body) left
      else begin
        on_wheels := true;
        let ahead = f64 () in
        ignore (need 32);
        Wheels.disc_fits left body ahead speed time_step
      end in
    let held = if version >= 5 then List.map holds (Array.to_list kinds) else [] in
    (q, every, (Array.map fst kinds, kind_of), edges, bodies, (tracking, !on_wheels, held)) in
  match block head with
  | None -> bad 8 "its end within the head"
  | Some (step, _, (kinds, kind_of), edges, bodies, (tracking, on_wheels, held)) ->
    let n = List.length kind_of in
    let numbers = step :: Array.to_list kinds @ List.concat_map (fun (a, b, c, d) -> [a; b; c; d]) edges in
    let q = fractions numbers in
    let unit = q step in
    let walls = List.rev_map (fun (a, b, c, d) -> Wall [(q a, q b); (q c, q d)]) edges in
    let radii = Array.map q kinds in
    let sizes = Array.of_list (List.rev (List.rev_map (fun k -> radii.(k)) kind_of)) in
    let x = Array.make n 0 and y = Array.make n 0 in
    let t = { asked = 0; robots_apart = 0; edges_clear = 0; first = None } in
    let column a = for i = 0 to n - 1 do a.(i) <- a.(i) + difference () done in
    let rec rows count last =
      let cut () = (count, true) in
      if !pos >= String.length s then cut () else match s.[need 1] with
        | 'R' -> (match block (fun () -> let k = u32 () in column x; column y; k) with
            | None -> cut ()
            | Some k ->
              let at v = { unit with qnum = Whole.mul (Whole.of_int v) unit.qnum } in
              let here = Array.init n (fun i -> (at x.(i), at y.(i))) in
              (* Of rows of consecutive steps the motion, of others its end. *)
              let before, anew = match last with Some (j, ps) when k = j + 1 -> (ps, false) | _ -> (here, true) in
              ignore (take t (Printf.sprintf "step %d" k) ~anew walls [] (List.init n (fun i -> { from = before.(i); to0 = here.(i); size = sizes.(i) })));
              rows (count + 1) (Some (k, here)))
        | 'E' -> (match block (fun () -> u64 ()) with
            | None -> cut ()
            | Some c -> if Int64.to_int c <> count || !pos <> String.length s then bad !pos "an end of other rows than these"; (count, false))
        | _ -> bad !pos "what begins neither a row nor the end" in
    let count, cut_off = rows 0 None in
    if held <> [] then Printf.printf "kinds whose discs hold bodies, arcs of a step on wheels, and the tracking error: %d asked, %d proven\n"
      (List.length held) (List.length (List.filter Fun.id held));
    let ok = report t "the first row and each step or row after it" count n ("one of " ^ counted (List.length walls) "edge")
      ((if bodies > 0 then [Printf.sprintf "that robots are clear of %d %s, moving or at rest," bodies (if bodies = 1 then "body" else "bodies")] else [])
       @ (if tracking > 0. then [within_tracking] else []) @ (if on_wheels then [of_wheels] else []) @ ["speeds"]) cut_off in
    if cut_off then Printf.printf "%s: the file was cut off after the last row\n" file;
    ok && List.for_all Fun.id held

(* --- Any of them --- *)
let is_crowd text = String.starts_with ~prefix:"EXACTVR" text && String.length text > 8 && String.contains "1235" text.[7]
(* Whether all of the file is verified. *)
let judge file =
  let text = read file in
  if is_crowd text then crowd file text
  else if String.starts_with ~prefix:"{\"header\"" text then recording file text
  else certificates file text
