(* SPDX-License-Identifier: GPL-3.0-or-later *)
(* JSON as the project writes it. Numbers are doubles; a member twice, and whatever is no JSON, is refused. *)
type t = Null | Bool of bool | Num of float | Str of string | Arr of t list | Obj of (string * t) list

exception Bad

let deepest = 100

(* The digits from k on, read behind those of m; ends up behind them, with the number in `digits_read`. *)
let digits_read = ref 0
let rec digits s n k m =
  if k < n && (let c = String.unsafe_get s k in c >= '0' && c <= '9') then digits s n (k + 1) (10 * m + Char.code (String.unsafe_get s k) - 48)
  else (digits_read := m; k)

(* The double nearest m / 10^k, for 0 <= m < 10^18, or nan where this does not decide. These powers are doubles, so that up to 2^53
   the quotient is rounded once. Beyond, q and `rest` add up to m / 10^k but for the two roundings of `rest`: what is subtracted
   and `low` are exact. As sums are rounded monotonically, m / 10^k is rounded as both of its bounds, where these agree. *)
let powers = Array.init 23 (fun k -> float_of_string (Printf.sprintf "1e%d" k))
let nearest m k =
  let p = powers.(k) and high = float_of_int m in
  let q = high /. p in
  if m < 1 lsl 53 then q else begin
    let low = float_of_int (m - int_of_float high) in
    let rest = (Float.fma (-. q) p high +. low) /. p in
    let x = q +. rest *. (1. -. 0x1p-50) in
    if x = q +. rest *. (1. +. 0x1p-50) then x else nan
  end

(* Names that were read before, so that most are no new strings. *)
let names = Array.make 256 ""
let name_at s first n =
  let k = (n + 7 * Char.code s.[first]) land 255 in
  let known = names.(k) in
  let rec same i = i = n || (String.unsafe_get known i = String.unsafe_get s (first + i) && same (i + 1)) in
  if String.length known = n && same 0 then known else (let t = String.sub s first n in names.(k) <- t; t)

(* What stands in s between two places. *)
let parse_part s (first, n) =
  let i = ref first in
  let peek () = if !i < n then s.[!i] else raise Bad in
  let rec blanks () = if !i < n && s.[!i] <= ' ' && (match s.[!i] with ' ' | '\t' | '\r' | '\n' -> true | _ -> false) then (incr i; blanks ()) in
  let expect c = if peek () = c then incr i else raise Bad in
  let word w v = String.iter expect w; v in
  let hex () = if !i + 4 > n then raise Bad; let v = int_of_string ("0x" ^ String.sub s !i 4) in i := !i + 4; v in
  let text () =
    expect '"';
    let rec plain k = if k >= n || s.[k] < ' ' then raise Bad else if s.[k] = '"' || s.[k] = '\\' then k else plain (k + 1) in
    let k = plain !i in
    let rec go b =
      let k = plain !i in
      Buffer.add_substring b s !i (k - !i); i := k + 1;
      if s.[k] = '\\' then begin
        let c = peek () in incr i;
        (match c with
         | '"' | '\\' | '/' -> Buffer.add_char b c
         | 'n' -> Buffer.add_char b '\n' | 't' -> Buffer.add_char b '\t' | 'r' -> Buffer.add_char b '\r'
         | 'b' -> Buffer.add_char b '\b' | 'f' -> Buffer.add_char b '\012'
         | 'u' -> let u = hex () in
           let u = if u land 0xFC00 = 0xD800 then (expect '\\'; expect 'u'; 0x10000 + ((u land 0x3FF) lsl 10) + (hex () land 0x3FF)) else u in
           Buffer.add_utf_8_uchar b (Uchar.of_int u)
         | _ -> raise Bad);
        go b
      end in
    if k > !i && s.[k] = '"' then (let t = name_at s !i (k - !i) in i := k + 1; t)
    else (let b = Buffer.create 16 in go b; Buffer.contents b) in
  let number () =
    let start = !i in
    let first = if peek () = '-' then start + 1 else start in
    let more k m = let stop = digits s n k m in if stop = k then raise Bad else stop in
    let leading = first < n && s.[first] = '0' in
    let point = if leading then (digits_read := 0; first + 1) else more first 0 in
    let stop = if point < n && s.[point] = '.' then more (point + 1) !digits_read else point in
    let m = !digits_read and behind = if stop > point then stop - point - 1 else 0 in
    i := stop;
    if stop < n && (s.[stop] = 'e' || s.[stop] = 'E') then (incr i; if peek () = '-' || peek () = '+' then incr i; i := more !i 0);
    let few = behind + (if leading then 0 else point - first) <= 18 in
    let x = if few && !i = stop then nearest m behind else nan in
    let x = if Float.is_nan x then float_of_string (String.sub s start (!i - start)) else if first > start then -. x else x in
    if Float.is_finite x then Num x else raise Bad in
  let rec value depth =
    if depth > deepest then raise Bad;
    blanks ();
    let v = match peek () with
      | '{' -> incr i; Obj (list '}' (fun () -> blanks (); let k = text () in blanks (); expect ':'; (k, value (depth + 1))) |> once)
      | '[' -> incr i; Arr (list ']' (fun () -> value (depth + 1)))
      | '"' -> Str (text ()) | 't' -> word "true" (Bool true) | 'f' -> word "false" (Bool false) | 'n' -> word "null" Null
      | _ -> number () in
    blanks (); v
  and list : 'a. char -> (unit -> 'a) -> 'a list = fun close item ->
    blanks ();
    if peek () = close then (incr i; []) else
      let rec more acc = let acc = item () :: acc in blanks (); if peek () = ',' then (incr i; more acc) else (expect close; List.rev acc) in
      more []
  and once members =
    let rec next_twice = function a :: (b :: _ as t) -> String.equal a b || next_twice t | _ -> false in
    let rec some_twice = function (a, _) :: t -> List.exists (fun (b, _) -> String.equal a b) t || some_twice t | [] -> false in
    let twice = if List.compare_length_with members 16 <= 0 then some_twice members else next_twice (List.sort String.compare (List.map fst members)) in
    if twice then raise Bad else members in
  match value 0 with
  | v -> if !i = n then v else raise Bad
  | exception (Invalid_argument _ | Failure _) -> raise Bad

let parse s = parse_part s (0, String.length s)

let find k =
  let rec among = function (name, v) :: t -> if String.equal name k then Some v else among t | [] -> None in
  function Obj m -> among m | _ -> None
let get k v = match find k v with Some x -> x | None -> raise Bad
let num = function Num x -> x | _ -> raise Bad
let str = function Str x -> x | _ -> raise Bad
let bool = function Bool x -> x | _ -> raise Bad
let arr = function Arr x -> x | _ -> raise Bad
let count v = let x = num v in if Float.is_integer x && x >= 0. && x < 1e9 then int_of_float x else raise Bad
